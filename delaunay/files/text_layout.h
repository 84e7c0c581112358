// The columns of a text of points, and its rows by them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "delaunay/files/input.h"
#include "delaunay/files/quantity.h"
#include "delaunay/files/text_rows.h"
#include "delaunay/points.h"

namespace delray::delaunay {

// columns[i] is the quantity in column i of the file.
struct TextLayout {
  std::vector<Quantity> columns;
  bool is_plane = false;    // unnamed columns, two in the first row
  bool geographic = false;  // columns are named longitude and latitude
  std::string warning;      // of columns that are left out, or guessed
  Separator separator = Separator::comma;
  TextPlace begin;  // of the first row of coordinates
};

// A first row of one or two whole numbers: how many points, and edges between them, may follow.
struct TextCounts {
  std::size_t points = 0, edges = 0;
  bool single = false;  // the line holds the number of points alone
};
std::optional<TextCounts> announced_counts(const Input& start);

// The layout that the first rows tell; the first one is none where it holds counts. `start` is the
// file or as much of it as has them, up to the end of a line. Throws FileError for names without x
// or y, and where there is no row.
TextLayout text_layout(const Input& start, bool with_counts);

// Whether the first row of coordinates, or of counts, is one.
bool begins_as_points(const Input& start);

class TextRowParser {
 public:
  explicit TextRowParser(const TextLayout& layout);

  bool has_z() const { return has_z_; }
  bool has_colour() const { return has_colour_; }
  bool has_intensity() const { return has_intensity_; }
  bool has_class() const { return has_class_; }
  // Makes room for `rows` points with what the columns have.
  void resize(PointCloud& cloud, std::size_t rows) const;
  // Fills in row `row`; of colours says whether they are whole numbers of 0 to 255. The intensity
  // is as it stands there. Throws FileError.
  bool parse(Fields& fields, std::size_t row, PointCloud& cloud) const;

 private:
  bool has(Quantity quantity) const;

  std::vector<Quantity> columns_;
  bool is_plane_, has_z_, has_colour_, has_intensity_, has_class_;
};

}  // namespace delray::delaunay
