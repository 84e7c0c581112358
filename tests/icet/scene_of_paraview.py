"""What pvbatch, or pvpython with a server, draws: contours of a source that ranks share, at some angles."""
import sys

from paraview.simple import (ColorBy, Connect, Contour, CreateView, Disconnect, Render, Show, Wavelet)

kind, frames, width, height = sys.argv[1], int(sys.argv[2]), int(sys.argv[3]), int(sys.argv[4])
if len(sys.argv) > 5:  # a server, at that port
    Connect('localhost', int(sys.argv[5]))
view = CreateView('RenderView')
view.ViewSize = [width, height]
view.OrientationAxesVisibility = 0
view.UseFXAA = 0  # it makes more of a rounding
view.UseColorPaletteForBackground = 0
view.Background = [0.2, 0.3, 0.5]
source = Wavelet(WholeExtent=[-20, 20, -20, 20, -20, 20])
contours = Contour(Input=source, ContourBy=['POINTS', 'RTData'], Isosurfaces=[120, 160, 200])
shown = Show(contours, view)
ColorBy(shown, ('POINTS', 'RTData'))
if kind == 'transparent':
    shown.Opacity = 0.4
if len(sys.argv) > 5:
    view.RemoteRenderThreshold = 0
view.CameraFocalPoint = [0, 0, 0]
view.CameraViewUp = [0, 1, 0]
for i in range(frames):
    view.CameraPosition = [70 + 3 * i, 50 - 2 * i, 90]
    Render(view)
if len(sys.argv) > 5:
    Disconnect()
