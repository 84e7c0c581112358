// Several files as one input of points, whole or in parts that memory need not hold.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include "delaunay/point_filter.h"
#include "delaunay/point_parts.h"
#include "delaunay/read_points.h"

namespace delray::delaunay {

// The files that `inputs` name, in the order given: files, folders (their files of points by
// suffix, in the order of their names, without sub-folders and texts that do not begin as points)
// and, where there is no file of that name, patterns with * and ? in the last name, as shells know
// them. "-" is standard input. Throws FileError (input) for a folder without files of points and a
// pattern that nothing matches.
std::vector<std::filesystem::path> expand_inputs(std::span<const std::filesystem::path> inputs);

// Of the folders among `inputs` the files with a suffix of points that expand_inputs() leaves out:
// texts and JSON whose first rows are no points, such as notes beside them.
std::vector<std::filesystem::path> left_out_of_folders(
    std::span<const std::filesystem::path> inputs);

// Opens files, folders and patterns as one input: rows are those of the points that `filter` keeps,
// in the order of the input, as read_points() below gives them. Reads headers and tables only.
//
// Text is cut at line ends, binary PLY, PCD and LAS between rows, LAZ between chunks, into parts of
// a few megabytes; of an octree (COPC) only the nodes are read that bounds and resolution need.
// What cannot be cut (other formats, standard input, text and PLY with faces or outlines) is read
// here and held in memory as long as the result lives. read() takes, besides the points, as much
// memory as the part has in the file. most_rows() of text counts its lines, by reading the part;
// elsewhere it costs nothing. Ranges of attributes that only all of a file tells (whether colours
// have 16 bits, the greatest intensity) are those of its first part, unless the options ask for
// those of all.
//
// A file's warnings come with the points of its first part. Throws FileError (input, memory), and
// std::invalid_argument where the filter asks for what a file does not have.
std::unique_ptr<PointParts> open_points(std::span<const std::filesystem::path> inputs,
                                        const PointFilter& filter = {},
                                        const ReadOptions& options = {});

// One input after another.
std::unique_ptr<PointParts> join_parts(std::vector<std::unique_ptr<PointParts>> inputs);

// All points of an input in parts, read in parallel in the caller's arena and joined as below.
PointCloud read_points(const PointParts& parts, const ReadOptions& options = {});

// All points of such an input, read in parallel in the caller's arena. Attributes that not all
// files have are left out, z is 0 where a file has none. Throws what open_points() throws and
// FileError (input) if there are no points.
PointCloud read_points(std::span<const std::filesystem::path> inputs, const PointFilter& filter,
                       const ReadOptions& options = {});

}  // namespace delray::delaunay
