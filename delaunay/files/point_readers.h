// The readers that the tables of read_points.h and read_mesh.h are made of, one file each.
#pragma once

#include "delaunay/files/input.h"
#include "delaunay/points.h"
#include "delaunay/read_mesh.h"

namespace delray::delaunay {

// Rows of numbers separated by blanks, tabs, commas or semicolons; an optional line of column names
// or of counts comes first (see read_text.cpp).
PointCloud read_text_points(const Input& input);
PointCloud read_ply_points(const Input& input);
PointCloud read_obj_points(const Input& input);
PointCloud read_off_points(const Input& input);
PointCloud read_las_points(const Input& input);
PointCloud read_json_points(const Input& input);
PointCloud read_node_points(const Input& input);
PointCloud read_vtu_points(const Input& input);

PointMesh read_ply_mesh(const Input& input);
PointMesh read_obj_mesh(const Input& input);
PointMesh read_off_mesh(const Input& input);
PointMesh read_stl_mesh(const Input& input);
PointMesh read_vtu_mesh(const Input& input);
// `input` is the .node file, `elements` the .ele file.
PointMesh read_node_mesh(const Input& input, const Input& elements);

}  // namespace delray::delaunay
