// The index of a mesh folder as text.
#pragma once

#include <string>

#include "delaunay/mesh_folder.h"

namespace delray::delaunay::internal {

// What parse_mesh_index() reads.
std::string mesh_index_text(const MeshIndex& index);

// An entry on a line of its own, as a journal of pieces has it, and back; throws
// std::invalid_argument for what is none.
std::string piece_text(const MeshPiece& piece);
MeshPiece parse_piece(const std::string& text);

// Whether a name is that of a piece.
bool is_piece_name(std::string_view name);
std::string piece_name(std::uint64_t tile, std::uint64_t part, std::string_view suffix);

}  // namespace delray::delaunay::internal
