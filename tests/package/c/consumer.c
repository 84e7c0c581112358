#include <delray.h>

int main(void) {
  const double points[8] = {0, 0, 1, 0, 0, 1, 1, 1};
  DelrayPoints all;
  DelrayTriangulation mesh;
  uint64_t count;
  all.data = points;
  all.type = DELRAY_FLOAT64;
  all.count = 4;
  all.stride = 0;
  if (delrayTriangulate(&all, NULL, &mesh) != DELRAY_SUCCESS) return 1;
  count = delraySimplexCount(mesh);
  delrayReleaseTriangulation(mesh);
  return count == 2 ? 0 : 1;
}
