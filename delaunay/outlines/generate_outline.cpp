// Outlines of lakes and countries: the lines where a fractal height field crosses zero (Lorensen
// and Cline 1987, in the plane), so that coasts, islands and holes come by themselves and no line
// crosses another.
//
// Heights are octaves of noise (Fournier, Fussell and Carpenter 1982) that fall off towards the
// border. Where two opposite corners of a cell are above zero, they are not connected. Each cell
// that the line passes gives one segment; how fine the lattice is follows from the number of
// points, by trials.
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <unordered_map>

#include "delaunay/mesh/random.h"
#include "delaunay/outline.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {
namespace {

// Heights at the corners of side * side cells over the unit square, row by row.
struct HeightLattice {
  std::size_t side = 0;
  std::vector<double> heights;

  std::size_t across() const { return side + 1; }
  bool is_above(std::size_t i) const { return heights[i] > 0; }
  glm::dvec2 place(std::size_t i) const {
    const std::size_t column = i % across(), row = i / across();
    const auto spacing = 1 / static_cast<double>(side);
    return spacing * glm::dvec2(static_cast<double>(column), static_cast<double>(row));
  }
  // Below zero without being near another corner.
  void sink(std::size_t i) { heights[i] = -std::abs(heights[i]); }
};

// Noise that interpolates random heights at the corners of a lattice.
class Octave {
 public:
  Octave(int number, std::uint64_t seed) : cells_(std::size_t{3} << number) {
    const std::size_t across = cells_ + 1;
    heights_.resize(across * across);
    parallel::parallel_for(0, heights_.size(), 4096, [&](std::size_t i) {
      heights_[i] = RowRandom(seed, static_cast<std::uint64_t>(number) << 56 | i).uniform(-1, 1);
    });
  }
  double at(const glm::dvec2& place) const {
    const glm::dvec2 in_cells = place * static_cast<double>(cells_);
    const auto x = std::min(static_cast<std::size_t>(in_cells.x), cells_ - 1),
               y = std::min(static_cast<std::size_t>(in_cells.y), cells_ - 1);
    const glm::dvec2 t = in_cells - glm::dvec2(static_cast<double>(x), static_cast<double>(y)),
                     smooth = t * t * (3.0 - 2.0 * t);
    const auto corner = [&](std::size_t i, std::size_t j) {
      return heights_[(y + j) * (cells_ + 1) + x + i];
    };
    return glm::mix(glm::mix(corner(0, 0), corner(1, 0), smooth.x),
                    glm::mix(corner(0, 1), corner(1, 1), smooth.x), smooth.y);
  }

 private:
  std::size_t cells_;
  std::vector<double> heights_;
};

HeightLattice fractal_heights(std::size_t side, double level, std::uint64_t seed) {
  std::vector<Octave> octaves;
  for (int octave = 0; (std::size_t{3} << octave) <= side; ++octave) {
    octaves.emplace_back(octave, seed);
  }
  HeightLattice lattice{side, {}};
  lattice.heights.resize(lattice.across() * lattice.across());
  parallel::parallel_for(0, lattice.across(), 8, [&](std::size_t y) {
    for (std::size_t x = 0; x < lattice.across(); ++x) {
      const std::size_t i = y * lattice.across() + x;
      const glm::dvec2 place = lattice.place(i), off = 2.0 * place - 1.0;
      const double square = glm::dot(off, off);
      double height = level - square * (0.6 + 0.8 * square), weight = 0.8;
      for (const Octave& octave : octaves) {
        height += weight * octave.at(place);
        weight *= 0.55;
      }
      // Away from zero, so that points keep away from corners, and from each other.
      constexpr double kLeast = 0.02;
      const bool is_border = x == 0 || y == 0 || x == side || y == side;
      height += height < 0 ? -kLeast : kLeast;
      lattice.heights[i] = is_border ? -std::abs(height) : height;
    }
  });
  return lattice;
}

// Corners of the lattice that lines do not part, as sets.
class LatticeSets {
 public:
  explicit LatticeSets(const HeightLattice& lattice) : parents_(lattice.heights.size()) {
    for (std::uint32_t i = 0; i < parents_.size(); ++i) parents_[i] = i;
    const std::size_t across = lattice.across();
    for (std::size_t i = 0; i < parents_.size(); ++i) {
      const bool has_right = i % across + 1 < across, has_up = i / across + 1 < across;
      const auto join = [&](std::size_t a, std::size_t b) {
        if (lattice.is_above(a) == lattice.is_above(b)) unite(a, b);
      };
      if (has_right) join(i, i + 1);
      if (has_up) join(i, i + across);
      if (!has_right || !has_up) continue;
      // Opposite corners below zero are connected, those above are not.
      if (!lattice.is_above(i)) join(i, i + across + 1);
      if (!lattice.is_above(i + 1)) join(i + 1, i + across);
    }
  }
  // The lowest corner in the set of a corner.
  std::uint32_t set_of(std::size_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return static_cast<std::uint32_t>(i);
  }

 private:
  void unite(std::size_t a, std::size_t b) {
    const std::uint32_t of_a = set_of(a), of_b = set_of(b);
    parents_[std::max(of_a, of_b)] = std::min(of_a, of_b);
  }

  std::vector<std::uint32_t> parents_;
};

// Leaves the largest set above zero alone there.
void keep_largest(HeightLattice& lattice) {
  LatticeSets sets(lattice);
  std::vector<std::uint32_t> sizes(lattice.heights.size());
  std::uint32_t largest = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (!lattice.is_above(i)) continue;
    const std::uint32_t set = sets.set_of(i);
    if (++sizes[set] > sizes[largest]) largest = set;
  }
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    if (lattice.is_above(i) && sets.set_of(i) != largest) lattice.sink(i);
  }
}

// The lines at zero, with what is above to their left.
class ZeroLines {
 public:
  explicit ZeroLines(const HeightLattice& lattice) : lattice_(lattice) {
    for (std::size_t y = 0; y < lattice.side; ++y) {
      for (std::size_t x = 0; x < lattice.side; ++x) add_cell(y * lattice.across() + x);
    }
  }
  Outline take() { return std::move(outline_); }

 private:
  void add_cell(std::size_t i) {
    const std::size_t across = lattice_.across();
    const std::array<std::size_t, 4> corners = {i, i + 1, i + across + 1, i + across};
    // Around the cell; each crossing from above to below begins a segment, which ends at the one
    // before it, around the corners above zero.
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t from = corners[k], to = corners[(k + 1) % 4];
      if (!lattice_.is_above(from) || lattice_.is_above(to)) continue;
      std::size_t before = k;
      while (lattice_.is_above(corners[before])) before = (before + 3) % 4;
      outline_.segments.push_back(
          {point_between(from, to), point_between(corners[(before + 1) % 4], corners[before])});
    }
  }
  std::uint32_t point_between(std::size_t above, std::size_t below) {
    const bool is_upwards = lattice_.place(above).x == lattice_.place(below).x;
    const std::uint64_t key = std::uint64_t{2} * std::min(above, below) + (is_upwards ? 1 : 0);
    const auto [entry, is_new] =
        points_.try_emplace(key, static_cast<std::uint32_t>(outline_.points.size()));
    if (is_new) {
      const double high = lattice_.heights[above], low = -lattice_.heights[below];
      const double part = std::clamp(high / (high + low), 0.1, 0.9);
      const glm::dvec2 p =
          lattice_.place(above) + part * (lattice_.place(below) - lattice_.place(above));
      outline_.points.positions.emplace_back(p, 0);
    }
    return entry->second;
  }

  const HeightLattice& lattice_;
  Outline outline_;
  std::unordered_map<std::uint64_t, std::uint32_t> points_;  // by the edge of the lattice
};

// A place in each set below zero that does not reach the border.
std::vector<glm::dvec2> holes_of(const HeightLattice& lattice) {
  LatticeSets sets(lattice);
  std::vector<glm::dvec2> holes;
  for (std::size_t i = 0; i < lattice.heights.size(); ++i) {
    if (!lattice.is_above(i) && sets.set_of(i) == i && i != 0) holes.push_back(lattice.place(i));
  }
  return holes;
}

struct CoastKind {
  double level;  // of the middle above zero: how much of the square is above
  bool is_one;   // the largest part alone
};

Outline coast(std::size_t side, const CoastKind& kind, std::uint64_t seed) {
  HeightLattice lattice = fractal_heights(side, kind.level, seed);
  if (kind.is_one) keep_largest(lattice);
  Outline outline = ZeroLines(lattice).take();
  outline.holes = holes_of(lattice);
  return outline;
}

// Of coasts of more and more cells across the first with enough points.
Outline coast_of(std::size_t n, const CoastKind& kind, std::uint64_t seed) {
  std::size_t side = 6;
  for (;;) {
    Outline outline = coast(side, kind, seed);
    const std::size_t size = outline.points.size();
    if (10 * size >= 8 * n) return outline;
    // Lines have about side^1.3 points.
    const double growth = size == 0 ? 2 : static_cast<double>(n) / static_cast<double>(size);
    const double factor = std::min(2.0, std::sqrt(growth) * std::sqrt(std::sqrt(growth)));
    side = std::max(side + 1, static_cast<std::size_t>(static_cast<double>(side) * factor));
  }
}

Outline lake(std::size_t n, std::uint64_t seed) { return coast_of(n, {0.55, true}, seed); }
Outline country(std::size_t n, std::uint64_t seed) { return coast_of(n, {0.35, false}, seed); }

// A star with spikes of a few degrees around a hole: corners below any bound.
Outline star(std::size_t n, std::uint64_t seed) {
  Outline outline;
  const std::size_t spikes = std::max<std::size_t>(3, (n - 3) / 2);
  RowRandom random(seed, 0);
  // Directions by powers of a rotation, which need no libm.
  const auto turn = [](double part) {
    // The point of the circle by a rational parametrization of each quarter.
    const auto quarter = static_cast<int>(part * 4);
    const double t = part * 4 - quarter;
    const glm::dvec2 p = glm::dvec2(1 - t * t, 2 * t) / (1 + t * t);
    const std::array<glm::dvec2, 4> turned = {p, {-p.y, p.x}, -p, {p.y, -p.x}};
    return turned[static_cast<std::size_t>(quarter % 4)];
  };
  const auto count = static_cast<double>(2 * spikes);
  for (std::size_t i = 0; i < 2 * spikes; ++i) {
    const double radius = i % 2 == 0 ? random.uniform(0.35, 0.5) : 0.15;
    const glm::dvec2 p = 0.5 + radius * turn(static_cast<double>(i) / count);
    outline.points.positions.emplace_back(p, 0);
    outline.segments.push_back(
        {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>((i + 1) % (2 * spikes))});
  }
  const auto first = static_cast<std::uint32_t>(2 * spikes);
  for (std::uint32_t k = 0; k < 3; ++k) {
    outline.points.positions.emplace_back(0.5 + 0.05 * turn(k / 3.0), 0);
    outline.segments.push_back({first + k, first + (k + 1) % 3});
  }
  outline.holes = {{0.5, 0.5}};
  return outline;
}

constexpr std::array kOutlines = {
    OutlineGenerator{"lake", "one lake with a fractal shore and islands", &lake},
    OutlineGenerator{"country", "land with a fractal coast, its islands and its lakes", &country},
    OutlineGenerator{"star", "sharp spikes around a hole", &star},
};

}  // namespace

std::span<const OutlineGenerator> outline_generators() { return kOutlines; }

Outline generate_outline(std::string_view kind, std::size_t n, std::uint64_t seed) {
  if (n < kFewestOutlinePoints || n > kMostOutlinePoints) {
    throw std::invalid_argument("outlines have " + std::to_string(kFewestOutlinePoints) + " to " +
                                std::to_string(kMostOutlinePoints) + " points");
  }
  std::string names;
  for (const OutlineGenerator& generator : kOutlines) {
    if (generator.name == kind) return generator.generate(n, seed);
    names += " " + std::string(generator.name);
  }
  throw std::invalid_argument("no kind of outlines is called \"" + std::string(kind) +
                              "\"; legal are" + names);
}

}  // namespace delray::delaunay
