// Tables of .node, .ele and .poly: a line of counts, then rows that begin with a number.
#pragma once

#include <cstdint>

#include "delaunay/files/input.h"
#include "delaunay/files/text_rows.h"
#include "delaunay/points.h"

namespace delray::delaunay {

struct NodeTable {
  RowIndex rows;
  std::int64_t columns = 0;     // dimension of points, corners of elements
  std::int64_t attributes = 0;  // per row
};

// The table that begins at `begin`: "rows columns attributes". Throws FileError where counts are
// missing or negative and where there are fewer rows.
NodeTable find_node_table(const Input& input, const char* what, TextPlace begin = {});

// The same of rows that are counted by a line of their own, "rows ...", as in .poly.
NodeTable find_counted_rows(const Input& input, const char* what, TextPlace begin);

// The number of the first row: 0 or 1.
std::int64_t first_number(const Input& input, const NodeTable& table);

// Points of dimension 2 or 3, numbered from `base`; the first attribute of points of the plane is
// their z.
PointCloud read_points_of(const Input& input, const NodeTable& table, std::int64_t base);

}  // namespace delray::delaunay
