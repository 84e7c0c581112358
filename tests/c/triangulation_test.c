/* Triangulations from C99: results, borrowed points of every layout, wrong arguments. */
#include <math.h>

#include "tests/c/check.h"

#define SIDE 20
#define POINTS (SIDE * SIDE)

static double lattice[POINTS][3]; /* a stride of three, of which two count in 2D */
static float floats[POINTS][2];

static void fill(void) {
  int i;
  for (i = 0; i < POINTS; ++i) {
    lattice[i][0] = i % SIDE;
    lattice[i][1] = i / SIDE;
    lattice[i][2] = (i * 7919) % 13;
    floats[i][0] = (float)lattice[i][0];
    floats[i][1] = (float)lattice[i][1];
  }
}

static DelrayPoints doubles(void) {
  DelrayPoints points;
  points.data = lattice;
  points.type = DELRAY_FLOAT64;
  points.count = POINTS;
  points.stride = sizeof(lattice[0]);
  return points;
}

static void test_lattice(void) {
  const DelrayPoints points = doubles();
  DelrayTriangulateOptions options = DELRAY_TRIANGULATE_OPTIONS;
  DelrayTriangulation mesh = NULL, same = NULL;
  DelrayVerdict verdict;
  DelrayPoints single;
  char hash[33], other[33];
  uint64_t facets = 0, i;
  uint32_t found[3], nearest;
  const double places[6] = {0.5, 0.25, SIDE - 1, SIDE - 1, -1, 3};
  double values[POINTS], result[3];

  options.threads = 2;
  OK(delrayTriangulate(&points, &options, &mesh));
  CHECK(delraySimplexCount(mesh) == 2 * (SIDE - 1) * (SIDE - 1));
  OK(delrayVerify(&points, 2, delraySimplices(mesh), delraySimplexCount(mesh), &verdict));
  CHECK(verdict.valid && verdict.delaunay && verdict.canonical && verdict.distinct == POINTS);
  CHECK(verdict.simplex == UINT64_MAX && verdict.reason[0] == '\0');
  CHECK(delrayHullFacets(mesh, &facets) != NULL && facets == 4 * (SIDE - 1));
  CHECK(delrayNeighbours(mesh) != NULL && delrayNeighbours(mesh) == delrayNeighbours(mesh));

  OK(delrayLocate(mesh, places, 3, found));
  CHECK(found[0] != DELRAY_NONE && found[1] != DELRAY_NONE && found[2] == DELRAY_NONE);
  OK(delrayNearest(mesh, places + 2, 1, &nearest));
  CHECK(nearest == POINTS - 1);
  for (i = 0; i < POINTS; ++i) values[i] = 2 * lattice[i][0] - lattice[i][1];
  OK(delrayInterpolate(mesh, DELRAY_LINEAR, values, places, 3, result));
  CHECK(fabs(result[0] - 0.75) < 1e-12 && isnan(result[2]));
  OK(delrayInterpolate(mesh, DELRAY_NATURAL_NEIGHBOUR, values, places, 1, result));
  CHECK(fabs(result[0] - 0.75) < 1e-9);

  single.data = floats;
  single.type = DELRAY_FLOAT32;
  single.count = POINTS;
  single.stride = 0;
  options.method = "optimistic";
  OK(delrayTriangulate(&single, &options, &same));
  OK(delrayHash(mesh, hash));
  OK(delrayHash(same, other));
  CHECK(strlen(hash) == 32 && strcmp(hash, other) == 0);
  delrayReleaseTriangulation(same);
  delrayReleaseTriangulation(mesh);
}

static void test_space(void) {
  const DelrayPoints points = doubles();
  DelrayTriangulateOptions options = DELRAY_TRIANGULATE_OPTIONS;
  DelrayTriangulation mesh = NULL;
  DelrayVerdict verdict;
  options.dim = 3;
  OK(delrayTriangulate(&points, &options, &mesh));
  OK(delrayVerify(&points, 3, delraySimplices(mesh), delraySimplexCount(mesh), &verdict));
  CHECK(verdict.canonical);
  OK(delrayVerify(&points, 3, delraySimplices(mesh), delraySimplexCount(mesh) - 1, &verdict));
  CHECK(!verdict.valid && verdict.reason[0] != '\0');
  delrayReleaseTriangulation(mesh);
}

static void test_refusals(void) {
  DelrayPoints points = doubles();
  DelrayTriangulateOptions options = DELRAY_TRIANGULATE_OPTIONS;
  DelrayTriangulation mesh = NULL;
  const double bad[4] = {0, 0, NAN, 1};
  options.dim = 4;
  FAILS(DELRAY_INVALID_ARGUMENT, delrayTriangulate(&points, &options, &mesh), "dim: 4");
  options.dim = 2;
  options.threads = 0;
  FAILS(DELRAY_INVALID_ARGUMENT, delrayTriangulate(&points, &options, &mesh), "threads: 0");
  options.threads = 1;
  options.method = "best";
  FAILS(DELRAY_INVALID_ARGUMENT, delrayTriangulate(&points, &options, &mesh), "best");
  FAILS(DELRAY_INVALID_ARGUMENT, delrayTriangulate(NULL, NULL, &mesh), "points is NULL");
  FAILS(DELRAY_INVALID_ARGUMENT, delrayTriangulate(&points, NULL, NULL), "triangulation is NULL");
  points.stride = 12;
  FAILS(DELRAY_INVALID_ARGUMENT, delrayTriangulate(&points, NULL, &mesh), "stride");
  points.stride = 0;
  points.type = DELRAY_INT32;
  FAILS(DELRAY_INVALID_ARGUMENT, delrayTriangulate(&points, NULL, &mesh), "type");
  points.type = DELRAY_FLOAT64;
  points.data = bad;
  points.count = 2;
  FAILS(DELRAY_INVALID_ARGUMENT, delrayTriangulate(&points, NULL, &mesh), "1");
  CHECK(mesh == NULL);
  CHECK(delraySimplices(NULL) == NULL && delraySimplexCount(NULL) == 0);
  delrayReleaseTriangulation(NULL);
  points.count = 0;
  points.data = NULL;
  OK(delrayTriangulate(&points, NULL, &mesh));
  CHECK(delraySimplexCount(mesh) == 0);
  delrayReleaseTriangulation(mesh);
}

int main(void) {
  CHECK(delrayApiVersion() == DELRAY_API_VERSION);
  CHECK(strchr(delrayVersion(), '.') != NULL);
  CHECK(delrayErrorText()[0] == '\0');
  fill();
  test_lattice();
  test_space();
  test_refusals();
  return 0;
}
