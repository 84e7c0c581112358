"""Draws scenes by Debian's ParaView under mpirun, with IceT's own libraries and with Delray's in their place, and
compares what every frame gave on every rank. Usage:

    with_paraview.py LIBDELRAY_ICET RECORD_FRAMES WORK_DIR [--ranks N,N...] [--kinds K,K...] [--size WxH] [--frames N] [--times] [--turns N]

Kinds: opaque and transparent (pvbatch), tiles and transparent-tiles (pvserver, 2 x 2, four ranks). Ends with 77 where ParaView is not
there, and with 1 where a channel of a pixel differs by more than rounding can make it. --times prints the medians of time in compositing;
both sides take so many --turns.
"""
import argparse
import os
import pathlib
import shutil
import socket
import statistics
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent


def free_port():
    with socket.socket() as probe:
        probe.bind(('localhost', 0))
        return probe.getsockname()[1]


def run(args, kind, ranks, side):
    """Frames of one side, {(rank, frame): pixels}, and lines of its times, {(rank, frame): numbers}."""
    folder = args.work / f'{kind}_{ranks}_{side}'
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    preload = str(args.record) + (f':{args.delray}' if side == 'delray' else '')
    environment = dict(os.environ, FRAMES=str(folder / 'frame'), OMPI_ALLOW_RUN_AS_ROOT='1', OMPI_ALLOW_RUN_AS_ROOT_CONFIRM='1',
                       OMPI_MCA_rmaps_base_oversubscribe='1', LP_NUM_THREADS='1')
    scene = [str(HERE / 'scene_of_paraview.py'), 'transparent' if 'transparent' in kind else 'opaque', str(args.frames),
             str(args.width), str(args.height)]
    mpirun = ['mpirun', '-n', str(ranks), '-x', f'LD_PRELOAD={preload}']
    log = folder / 'log'
    with open(log, 'w') as out:
        if 'tiles' not in kind:
            status = subprocess.run(mpirun + ['pvbatch', '--force-offscreen-rendering'] + scene, env=environment, stdout=out,
                                    stderr=subprocess.STDOUT).returncode
        else:
            port = free_port()
            server = subprocess.Popen(mpirun + ['pvserver', '--force-offscreen-rendering', f'--server-port={port}', '--tdx=2', '--tdy=2'],
                                      env=environment, stdout=out, stderr=subprocess.STDOUT)
            while server.poll() is None and 'Accepting connection' not in log.read_text():
                time.sleep(0.1)
            status = subprocess.run(['pvpython', '--force-offscreen-rendering'] + scene + [str(port)],
                                    env=environment, stdout=out, stderr=subprocess.STDOUT).returncode
            try:
                status = server.wait(timeout=30) or status
            except subprocess.TimeoutExpired:  # its client has failed
                server.kill()
                status = status or 1
    images, times = {}, {}
    for rank in range(ranks):
        lines = folder / f'frame.{rank}'
        if not lines.exists():
            continue
        for line in lines.read_text().splitlines():
            frame, tile, width, height, mode, *seconds = line.split()
            times[rank, int(frame)] = [float(value) for value in seconds]
            pixels = folder / f'frame.{rank}.{frame}'
            if pixels.exists():
                images[rank, int(frame)] = (int(width), int(height), mode, pixels.read_bytes())
    if status != 0 or not images:
        sys.exit(f'{kind}, {ranks} ranks, {side}: ended with {status}, {len(images)} images\n{log.read_text()[-2000:]}')
    return images, times


def compare(kind, ranks, icet, delray):
    if icet.keys() != delray.keys():
        sys.exit(f'{kind}, {ranks} ranks: images on {sorted(icet)} and on {sorted(delray)}')
    worst = covered = differing = 0
    for key, (width, height, mode, expected) in icet.items():
        if delray[key][:3] != (width, height, mode):
            sys.exit(f'{kind}, {ranks} ranks, {key}: {delray[key][:3]} is not {(width, height, mode)}')
        got = delray[key][3]
        covered += sum(1 for alpha in expected[3::4] if alpha)
        if got == expected:
            continue
        for a, b in zip(expected, got):
            if a != b:
                worst = max(worst, abs(a - b))
                differing += 1
    most = ranks - 1 if 'transparent' in kind else 0
    print(f'{kind}, {ranks} ranks: {len(icet)} images, {covered} covered pixels, {differing} channels differ, by {worst} at most')
    if covered == 0:
        sys.exit('nothing was drawn')
    if worst > most:
        sys.exit(f'channels may differ by {most} at most')


def print_times(turns):
    """Medians over turns of medians over frames but the first: from the last rank's drawing to the last rank's end, all of the frame,
    and ICET_COMPOSITE_TIME, which has the time that ranks wait for others to draw in it, too, of the slowest rank."""
    def median(times, seconds):
        frames = sorted({frame for _, frame in times})[1:]
        return statistics.median(seconds([times[key] for key in times if key[1] == frame]) for frame in frames)
    for name, seconds in (('drawn to done', lambda rows: max(row[4] for row in rows) - max(row[3] for row in rows)),
                          ('frame', lambda rows: max(row[0] for row in rows)),
                          ('ICET_COMPOSITE_TIME', lambda rows: max(row[1] for row in rows))):
        theirs, ours = ([median(turn[side], seconds) for turn in turns] for side in (0, 1))
        ratios = [mine / other for mine, other in zip(ours, theirs)]
        print(f'  {name}: {1e3 * statistics.median(ours):.2f} ms for {1e3 * statistics.median(theirs):.2f} ms of IceT, '
              f'{statistics.median(ratios):.2f} ({" ".join(f"{ratio:.2f}" for ratio in ratios)})', flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('delray', type=pathlib.Path)
    parser.add_argument('record', type=pathlib.Path)
    parser.add_argument('work', type=pathlib.Path)
    parser.add_argument('--ranks', default='2')
    parser.add_argument('--kinds', default='opaque,transparent')
    parser.add_argument('--size', default='400x300')
    parser.add_argument('--frames', type=int, default=2)
    parser.add_argument('--times', action='store_true')
    parser.add_argument('--turns', type=int, default=1)
    args = parser.parse_args()
    for library in (args.delray, args.record):
        if not library.exists():  # LD_PRELOAD only warns, and IceT would be compared with itself
            sys.exit(f'{library} is not there')
    args.width, args.height = (int(value) for value in args.size.split('x'))
    for program in ('pvbatch', 'pvserver', 'pvpython', 'xvfb-run', 'mpirun'):
        if shutil.which(program) is None:
            print(f'skipped: there is no {program}, see scripts/setup paraview python3-paraview xvfb')
            sys.exit(77)
    if 'WITH_XVFB' not in os.environ:  # one display for all
        os.execvpe('xvfb-run', ['xvfb-run', '-a', '-s', '-noreset -screen 0 1920x1200x24', sys.executable] + sys.argv, dict(os.environ, WITH_XVFB='1'))
    for kind in args.kinds.split(','):
        for ranks in [4] if 'tiles' in kind else [int(value) for value in args.ranks.split(',')]:
            turns = []
            for _ in range(args.turns):
                icet, icet_times = run(args, kind, ranks, 'icet')
                delray, delray_times = run(args, kind, ranks, 'delray')
                compare(kind, ranks, icet, delray)
                turns.append((icet_times, delray_times))
            if args.times:
                print_times(turns)


if __name__ == '__main__':
    main()
