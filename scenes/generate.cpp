// The table of generated scenes, and the parser of their names. Scenes are ordered for locality
// after they are made; parts are not, since their generators number triangles in such an order
// already.
#include "scenes/generate.h"

#include <array>
#include <stdexcept>
#include <string>
#include <vector>

#include "files/parse_count.h"
#include "files/similar_name.h"
#include "scenes/generators/generators.h"
#include "scenes/geometry/order.h"

namespace delray::scenes {
namespace {

constexpr std::string_view kPrefix = "gen:";
constexpr std::uint64_t kDefaultSeed = 1;

constexpr std::array kGenerators = {
    Generator{"terrain", "fractal height field with lakes, woods and snow", 1'000'000, 32,
              &internal::generate_terrain, &internal::generate_terrain_part},
    Generator{"cornell", "the Cornell box: two blocks under an area light", 40, 34,
              &internal::generate_cornell},
    Generator{"spheres", "reflective and refractive spheres over a chequered plane", 500'000, 7,
              &internal::generate_spheres},
    Generator{"city", "blocks of buildings, high in the middle, between streets", 1'000'000, 105,
              &internal::generate_city},
    Generator{"field", "a thousand instances of four detailed models on a plain", 13'000'000, 1,
              &internal::generate_field},
    Generator{"corner", "glass spheres in a corner of the picture: uneven work for rays", 100'000,
              1, &internal::generate_corner},
    Generator{"machine", "a thousand parts that move: gears, pistons and lamps", 1'000'000, 2,
              &internal::generate_machine},
    Generator{"cloth", "a flag in the wind, by morph targets", 200'000, 200,
              &internal::generate_cloth},
    Generator{"arm", "an arm that bends, by a skin over a chain of joints", 100'000, 150,
              &internal::generate_arm}};

[[noreturn]] void refuse(std::string_view name, const std::string& why) {
  std::string message =
      "'" + std::string(name) + "': " + why + "; gen:KIND[:TRIANGLES[:SEED]], KIND one of";
  for (const Generator& g : kGenerators) message += std::string(" ") + g.name;
  throw std::invalid_argument(message);
}

// Cuts the text up to the next colon off `rest`.
std::string_view next_field(std::string_view& rest) {
  const std::size_t colon = rest.find(':');
  const std::string_view field = rest.substr(0, colon);
  rest = colon == std::string_view::npos ? std::string_view{} : rest.substr(colon + 1);
  return field;
}

std::uint64_t number(std::string_view name, std::string_view text) {
  try {
    return files::parse_count(text);
  } catch (const std::invalid_argument& error) {
    refuse(name, error.what());
  }
}

struct Wanted {
  const Generator* generator = nullptr;
  std::uint64_t triangles = 0, seed = kDefaultSeed;
};

Wanted parsed(std::string_view name) {
  if (!name.starts_with(kPrefix)) refuse(name, "does not start with gen:");
  std::string_view rest = name.substr(kPrefix.size());
  const std::string_view kind = next_field(rest), triangles = next_field(rest),
                         seed = next_field(rest);
  if (!rest.empty()) refuse(name, "has too many parts");
  for (const Generator& g : kGenerators) {
    if (kind != g.name) continue;
    Wanted wanted{&g};
    wanted.triangles = triangles.empty() ? g.default_triangles : number(name, triangles);
    if (wanted.triangles < 1 || wanted.triangles > kMostTriangles)
      refuse(name, "triangles must be from 1 to 1e9");
    if (!seed.empty()) wanted.seed = number(name, seed);
    return wanted;
  }
  std::vector<std::string> kinds;
  for (const Generator& g : kGenerators) kinds.emplace_back(g.name);
  refuse(name, "there is no such kind of scene" + files::did_you_mean(kind, kinds));
}

}  // namespace

std::span<const Generator> generators() { return kGenerators; }

bool is_generated(std::string_view name) { return name.starts_with(kPrefix); }

std::string full_name(std::string_view name) {
  const Wanted wanted = parsed(name);
  return std::string(kPrefix) + wanted.generator->name + ":" + std::to_string(wanted.triangles) +
         ":" + std::to_string(wanted.seed);
}

std::uint64_t generated_bytes(std::string_view name) {
  const Wanted wanted = parsed(name);
  return static_cast<std::uint64_t>(static_cast<double>(wanted.triangles) *
                                    wanted.generator->bytes_per_triangle);
}

Scene generate(std::string_view name) {
  const Wanted wanted = parsed(name);
  Scene scene = wanted.generator->generate(wanted.triangles, wanted.seed);
  // Meshes that bend have an order that their displacements know of.
  std::vector<std::uint8_t> bends(scene.meshes.size(), 0);
  for (const DeformedMesh& deformed : scene.animations.meshes) bends[deformed.mesh] = 1;
  for (std::size_t i = 0; i < bends.size(); ++i)
    if (bends[i] == 0) internal::order_for_locality(scene.meshes[i]);
  return scene;
}

bool has_parts(std::string_view name) {
  return is_generated(name) && parsed(name).generator->generate_part != nullptr;
}

ScenePart generate_part(std::string_view name, int part, int parts) {
  const Wanted wanted = parsed(name);
  // Generators with parts number triangles so that order_for_locality leaves them as they are.
  return wanted.generator->generate_part(wanted.triangles, wanted.seed, part, parts);
}

}  // namespace delray::scenes
