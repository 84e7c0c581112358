// The readers behind the tables of read_points.h and read_mesh.h, one file each.
#pragma once

#include <array>

#include "delaunay/dimensions.h"
#include "delaunay/files/input.h"
#include "delaunay/files/text_rows.h"
#include "delaunay/outline.h"
#include "delaunay/points.h"
#include "delaunay/read_mesh.h"
#include "delaunay/read_points.h"

namespace delray::delaunay {

// Rows of numbers separated by blanks, tabs, commas or semicolons; an optional line of column names
// or of counts comes first (see read_text.cpp).
PointCloud read_text_points(const Input& input);
PointCloud read_ply_points(const Input& input);
PointCloud read_obj_points(const Input& input);
PointCloud read_off_points(const Input& input);
PointCloud read_las_points(const Input& input);
PointCloud read_pcd_points(const Input& input);
PointCloud read_json_points(const Input& input);
PointCloud read_node_points(const Input& input);
PointCloud read_poly_points(const Input& input);
PointCloud read_vtu_points(const Input& input);

// The table: which reader reads which format.
inline constexpr std::array kPointReaders = {
    PointReader{files::Format::text, "XYZ",
                "points as rows of numbers: x y [z], or columns named in a first line",
                ".xyz .csv .txt .tsv .asc .pts", &read_text_points},
    PointReader{files::Format::ply, "PLY", "points, ASCII or binary, or the vertices of faces",
                ".ply", &read_ply_points},
    PointReader{files::Format::obj, "OBJ", "points, or the vertices of a Wavefront model", ".obj",
                &read_obj_points},
    PointReader{files::Format::off, "OFF", "points, or the vertices of an object file", ".off",
                &read_off_points},
    PointReader{files::Format::las, "LAS", "LiDAR points, LAS 1.0 to 1.4, LAZ, COPC", ".las .laz",
                &read_las_points},
    PointReader{files::Format::pcd, "PCD",
                "points of the Point Cloud Library: ascii, binary, binary_compressed", ".pcd",
                &read_pcd_points},
    PointReader{files::Format::json_points, "JSON", "points as [[x, y], ...] or [[x, y, z], ...]",
                ".json", &read_json_points},
    PointReader{files::Format::node, "NODE", "points of Triangle and TetGen", ".node",
                &read_node_points},
    PointReader{files::Format::poly, "POLY", "the points of an outline of Triangle", ".poly",
                &read_poly_points},
    PointReader{files::Format::vtu, "VTU", "the points of an unstructured grid that delray wrote",
                ".vtu", &read_vtu_points},
};

PointMesh read_ply_mesh(const Input& input);
PointMesh read_obj_mesh(const Input& input);
PointMesh read_off_mesh(const Input& input);
PointMesh read_stl_mesh(const Input& input);
PointMesh read_vtu_mesh(const Input& input);
// `input` is the .node file, `elements` the .ele file.
PointMesh read_node_mesh(const Input& input, const Input& elements);
// As of outline.h; `nodes` is the .node file beside it, null where there is none.
Outline read_outline(const Input& input, const Input* nodes);
// Tables of .node, .ele and .poly: a line of counts, then rows that begin with a number.
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

// The next field as a number counted from `base`; one below it is beyond all that there are.
inline std::uint64_t number_from(std::int64_t base, Fields& fields) {
  return static_cast<std::uint64_t>(fields.integer()) - static_cast<std::uint64_t>(base);
}

// Points of dimension 2 or 3, numbered from `base`; the first attribute of points of the plane is
// their z.
PointCloud read_points_of(const Input& input, const NodeTable& table, std::int64_t base);

// As of dimensions.h.
PointTable read_point_table(const Input& input);
TableMesh read_table_mesh(const Input& input, const Input& elements);

}  // namespace delray::delaunay
