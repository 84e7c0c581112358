// Writes and reads a film with a fingerprint in front and a checksum behind, and hashes scenes with
// XXH3. Whatever a file says is checked before it is used: checksum, fingerprint and window before
// memory is taken, then its size, every cell and every pixel.
#include "raytrace/checkpoint.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>

#include "files/atomic_file.h"
#include "files/error.h"
#include "files/read_file.h"

namespace delray::raytrace {
namespace {

// A file is: the magic; the size of the values, and these, a line each, name and value with a tab
// between them; samples of a pixel, at most; the film: window, samples, costs, sums; the checksum.
constexpr std::string_view kMagic = "delray film 2\n";
constexpr std::string_view kAnyMagic = kMagic.substr(0, 12);
constexpr std::string_view kScene = "scene";
constexpr std::size_t kChecksum = 16;

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

std::string text_of(const Rendering& rendering) {
  std::string text = fmt::format("{}\t{}\n", kScene, rendering.scene);
  for (const NamedValue& v : rendering.values) text += v.name + "\t" + v.value + "\n";
  return text;
}

// None where it is no such text.
std::optional<std::vector<NamedValue>> values_in(std::string_view text) {
  std::vector<NamedValue> values;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view line = text.substr(0, end);
    const std::size_t tab = line.find('\t');
    const bool printable =
        std::ranges::all_of(line, [](char c) { return c == '\t' || (c >= ' ' && c <= '~'); });
    if (tab == std::string_view::npos || !printable) return std::nullopt;
    values.push_back({std::string(line.substr(0, tab)), std::string(line.substr(tab + 1))});
    text.remove_prefix(end + 1);
  }
  return values;
}

std::string value_of(std::string_view name, const std::vector<NamedValue>& values) {
  const auto found = std::ranges::find(values, name, &NamedValue::name);
  return found == values.end() ? "nothing" : found->value;
}

// "--depth 8 there, 2 here; ..."; empty where nothing differs.
std::string differences(const std::vector<NamedValue>& there, const Rendering& here) {
  std::string text;
  for (const NamedValue& v : here.values) {
    const std::string other = value_of(v.name, there);
    if (other == v.value) continue;
    text += fmt::format("{}{} {} there, {} here", text.empty() ? "" : "; ", v.name, other, v.value);
  }
  if (text.empty() && value_of(kScene, there) != here.scene) return "of another scene or light";
  return text;
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

// The error in a cell of the film and its pixels; null if there is none.
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

// Why a film begun for so many samples cannot go on to those of the rendering; null: it can.
std::string fault_of_samples(const Film& film, int there, const Rendering& here) {
  if (there == here.samples) return {};
  const std::string both = fmt::format("--spp {} there, {} here", there, here.samples);
  if (!here.any_samples) {
    return both +
           ": samples lie on a grid of all of them (with path, ao, --noise or --time they "
           "do not)";
  }
  std::uint32_t most = 0;
  for (const std::uint32_t samples : film.samples()) most = std::max(most, samples);
  if (most > static_cast<std::uint32_t>(here.samples)) {
    return fmt::format("{}: there are {} samples per pixel already", both, most);
  }
  if (!is_whole(most, here.samples)) {
    return fmt::format("{}: what would be the next {} samples ends with the first {} there", both,
                       chunk_size(static_cast<int>(most)),
                       static_cast<int>(most) % chunk_size(static_cast<int>(most)));
  }
  return {};
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
    if (!mesh.has_triangles())
      hasher.add_numbers(mesh.shape.kind, mesh.shape.in_pixels, mesh.shape.radius);
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

bool is_checkpoint(const std::filesystem::path& path) {
  std::error_code error;
  return std::filesystem::is_regular_file(path, error) &&
         files::read_start(path, kAnyMagic.size()) == kAnyMagic;
}

void save_checkpoint(const std::filesystem::path& path, const Rendering& rendering,
                     const Film& film) {
  const std::string text = text_of(rendering);
  const std::uint64_t size = text.size();
  std::string content(kMagic);
  append(content, std::span<const std::uint64_t>(&size, 1));
  content += text;
  append(content, std::span<const int>(&rendering.samples, 1));
  const geometry::Rect& window = film.window();
  append(content, std::span<const geometry::Rect>(&window, 1));
  append(content, film.samples());
  append(content, film.costs());
  append(content, film.pixels());
  content += checksum(content);
  files::write_file(path, content);
}

Film load_checkpoint(const std::filesystem::path& path, const Rendering& rendering,
                     const files::MemoryBudget& memory) {
  // What is no checkpoint may have no end.
  if (files::read_start(path, kAnyMagic.size(), memory) != kAnyMagic) {
    throw files::FileError(files::Cause::input, path.string(), "", "this is no checkpoint");
  }
  return parse_checkpoint(files::read_file(path, memory), path.string(), rendering);
}

Film parse_checkpoint(std::string_view content, const std::string& name,
                      const Rendering& rendering) {
  const auto require = [&](bool fine, const std::string& why, const std::string& place = "") {
    if (!fine) throw files::FileError(files::Cause::input, name, place, why);
  };
  const std::string damaged = "the checkpoint is damaged";
  std::string_view rest = content;
  require(rest.starts_with(kAnyMagic), "this is no checkpoint");
  require(rest.starts_with(kMagic), "the checkpoint is of another version of delray, or damaged");
  std::uint64_t size = 0;
  int samples = 0;
  geometry::Rect window;
  constexpr std::size_t kFixed =
      kMagic.size() + sizeof size + sizeof samples + sizeof window + kChecksum;
  require(rest.size() >= kFixed, damaged);
  require(checksum(rest.substr(0, rest.size() - kChecksum)) == rest.substr(rest.size() - kChecksum),
          damaged);
  rest.remove_suffix(kChecksum);
  rest.remove_prefix(kMagic.size());
  take(rest, std::span(&size, 1));
  require(size <= content.size() - kFixed, damaged);
  const auto values = values_in(rest.substr(0, size));
  rest.remove_prefix(size);
  require(values.has_value(), damaged);
  const std::string other = differences(*values, rendering);
  require(other.empty(), "the checkpoint is of another rendering: " + other);
  take(rest, std::span(&samples, 1));
  require(samples >= 1, damaged);
  take(rest, std::span(&window, 1));
  require(window == rendering.window, "the checkpoint is of another part of the picture");
  Film film(window);
  const std::size_t bytes =
      film.samples().size_bytes() + film.costs().size_bytes() + film.pixels().size_bytes();
  require(rest.size() == bytes, damaged);
  take(rest, film.samples());
  take(rest, film.costs());
  take(rest, film.pixels());
  for (std::size_t c = 0; c < film.samples().size(); ++c) {
    const char* const fault = fault_of_cell(film, c, samples);
    if (fault != nullptr) require(false, fault, fmt::format("cell {}", c));
  }
  const std::string fault = fault_of_samples(film, samples, rendering);
  require(fault.empty(), "the checkpoint is of another rendering: " + fault);
  return film;
}

}  // namespace delray::raytrace
