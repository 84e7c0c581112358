// Writes and reads a film with a fingerprint in front and a checksum behind, and hashes scenes with
// XXH3. Whatever a file says is checked before it is used: checksum, fingerprint and window before
// memory is taken, then its size, every cell and every pixel.
#include "raytrace/checkpoint.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <cmath>
#include <cstring>
#include <memory>

#include "files/atomic_file.h"
#include "files/error.h"
#include "files/read_file.h"

namespace delray::raytrace {
namespace {

constexpr std::string_view kMagic = "delray film 1\n";
constexpr std::size_t kFingerprint = 32, kChecksum = 16;

static_assert(sizeof(PixelSum) == 6 * sizeof(float) && sizeof(CellCost) == 2 * sizeof(float));

class Hasher {
 public:
  Hasher() : state_(XXH3_createState(), XXH3_freeState) { XXH3_128bits_reset(state_.get()); }

  void add(const void* data, std::size_t bytes) {
    if (bytes > 0) XXH3_128bits_update(state_.get(), data, bytes);
  }
  template <class T>
  void add(const std::vector<T>& values) {
    const std::uint64_t size = values.size();
    add(&size, sizeof(size));
    add(values.data(), values.size() * sizeof(T));
  }
  template <class... Numbers>
  void add_numbers(const Numbers&... numbers) {
    (add(&numbers, sizeof(numbers)), ...);
  }
  std::string digits() const {
    const XXH128_hash_t value = XXH3_128bits_digest(state_.get());
    return fmt::format("{:016x}{:016x}", value.high64, value.low64);
  }

 private:
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_;
};

void add_material(const scenes::Material& m, Hasher& hasher) {
  hasher.add_numbers(m.base_colour, m.metallic, m.roughness, m.transmission, m.ior, m.emission,
                     m.normal_scale, m.alpha, m.alpha_cutoff, m.double_sided, m.unlit, m.specular,
                     m.specular_colour, m.clearcoat, m.clearcoat_roughness, m.sheen_colour,
                     m.sheen_roughness, m.attenuation_colour, m.attenuation_distance, m.thickness,
                     m.textures());
}

template <class T>
void append(std::string& to, std::span<const T> values) {
  to.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
}

template <class T>
void take(std::string_view& from, std::span<T> values) {
  if (!values.empty()) std::memcpy(values.data(), from.data(), values.size_bytes());
  from.remove_prefix(values.size_bytes());
}

std::string checksum(std::string_view content) {
  const XXH128_hash_t value = XXH3_128bits(content.data(), content.size());
  std::string result(kChecksum, '\0');
  std::memcpy(result.data(), &value, kChecksum);
  return result;
}

// Whether a pixel that has got so many samples gets another chunk, or has got all.
bool is_whole(std::uint32_t samples, int most) {
  if (samples > static_cast<std::uint32_t>(most)) return false;
  const int size = chunk_size(static_cast<int>(samples));
  return samples == static_cast<std::uint32_t>(most) || static_cast<int>(samples) % size == 0;
}

bool is_possible(const PixelSum& sum) {
  const image::RgbaF& c = sum.colour;
  for (const float value : {c.r, c.g, c.b, c.a, sum.squares, sum.depth}) {
    if (std::isnan(value)) return false;
  }
  return sum.squares >= 0.0F && c.a >= 0.0F;
}

// What is wrong with a cell of the film and its pixels; null: nothing.
const char* fault_of_cell(const Film& film, std::size_t cell, int most) {
  const std::uint32_t samples = film.samples()[cell];
  if (!is_whole(samples, most)) return "the number of samples is impossible";
  const CellCost& cost = film.costs()[cell];
  if (!(cost.rays >= 0.0F) || !(cost.seconds >= 0.0F)) return "the cost is impossible";
  const geometry::Rect pixels = film.cell(cell);
  const PixelSum none;
  for (int y = pixels.y0; y < pixels.y1; ++y) {
    for (int x = pixels.x0; x < pixels.x1; ++x) {
      const PixelSum& sum = film.pixels()[film.pixel(x, y)];
      if (!is_possible(sum)) return "a sum of samples is impossible";
      if (samples == 0 && std::memcmp(&sum, &none, sizeof none) != 0) {
        return "there are sums of no samples";
      }
    }
  }
  return nullptr;
}

}  // namespace

std::string fingerprint(const scenes::Scene& scene, std::string_view settings) {
  Hasher hasher;
  hasher.add(settings.data(), settings.size());
  for (const scenes::Mesh& mesh : scene.meshes) {
    hasher.add(mesh.positions);
    hasher.add(mesh.normals);
    hasher.add(mesh.uvs);
    hasher.add(mesh.uvs2);
    hasher.add(mesh.tangents);
    hasher.add(mesh.colours);
    hasher.add(mesh.triangles);
    hasher.add_numbers(mesh.material);
  }
  hasher.add(scene.instances);
  for (const scenes::Material& material : scene.materials) add_material(material, hasher);
  for (const scenes::Texture& texture : scene.textures) {
    hasher.add(texture.texels);
    hasher.add(texture.radiance);
    hasher.add_numbers(texture.width, texture.height, texture.srgb, texture.wrap_u, texture.wrap_v,
                       texture.set);
  }
  for (const scenes::Light& light : scene.lights) {
    hasher.add_numbers(light.kind, light.colour, light.position, light.direction, light.edge_u,
                       light.edge_v);
  }
  const scenes::Environment& sky = scene.environment;
  hasher.add_numbers(sky.texture, sky.rotation, sky.up, sky.zenith, sky.horizon, sky.ground);
  return hasher.digits();
}

void save_checkpoint(const std::filesystem::path& path, std::string_view fingerprint,
                     const Film& film) {
  std::string content(kMagic);
  content += fingerprint;
  const geometry::Rect& window = film.window();
  append(content, std::span<const geometry::Rect>(&window, 1));
  append(content, film.samples());
  append(content, film.costs());
  append(content, film.pixels());
  content += checksum(content);
  files::write_file(path, content);
}

Film load_checkpoint(const std::filesystem::path& path, const Resumed& resumed,
                     const files::MemoryBudget& memory) {
  // What is no checkpoint may have no end.
  if (files::read_start(path, kMagic.size(), memory) != kMagic) {
    throw files::FileError(files::Cause::input, path.string(), "", "this is no checkpoint");
  }
  return parse_checkpoint(files::read_file(path, memory), path.string(), resumed);
}

Film parse_checkpoint(std::string_view content, const std::string& name, const Resumed& resumed) {
  const auto fail = [&](const std::string& place, const char* why) {
    return files::FileError(files::Cause::input, name, place, why);
  };
  std::string_view rest = content;
  constexpr std::size_t kLeast = kMagic.size() + kFingerprint + sizeof(geometry::Rect) + kChecksum;
  if (!rest.starts_with(kMagic) || rest.size() < kLeast) throw fail("", "this is no checkpoint");
  if (checksum(rest.substr(0, rest.size() - kChecksum)) != rest.substr(rest.size() - kChecksum)) {
    throw fail("", "the checkpoint is damaged");
  }
  rest.remove_suffix(kChecksum);
  rest.remove_prefix(kMagic.size());
  if (rest.substr(0, kFingerprint) != resumed.fingerprint) {
    throw fail("", "the checkpoint is of another scene or of other options");
  }
  rest.remove_prefix(kFingerprint);
  geometry::Rect window;
  take(rest, std::span<geometry::Rect>(&window, 1));
  if (window != resumed.window) throw fail("", "the checkpoint is of another part of the picture");
  Film film(window);
  const std::size_t bytes =
      film.samples().size_bytes() + film.costs().size_bytes() + film.pixels().size_bytes();
  if (rest.size() != bytes) throw fail("", "the checkpoint is damaged");
  take(rest, film.samples());
  take(rest, film.costs());
  take(rest, film.pixels());
  for (std::size_t c = 0; c < film.samples().size(); ++c) {
    const char* const fault = fault_of_cell(film, c, resumed.samples);
    if (fault != nullptr) throw fail(fmt::format("cell {}", c), fault);
  }
  return film;
}

}  // namespace delray::raytrace
