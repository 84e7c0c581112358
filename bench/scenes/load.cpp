// How fast scene files are loaded, and how much memory it takes, beside another build of this
// program: each run is a process of its own, both builds take turns, medians count.
//
//   scenes_load --make FOLDER                          writes terrain.glb, .ply, .obj, .stl ...
//   scenes_load --beside OTHER/scenes_load FILE...     ratios
//   scenes_load FILE...                                this build alone
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <bit>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>

#include "bench/measure.h"
#include "bench/ratio.h"
#include "files/error.h"
#include "parallel/arena.h"
#include "scenes/generate.h"
#include "scenes/load.h"
#include "scenes/write_glb.h"

namespace {

using namespace delray;

struct Result {
  double seconds = 0;
  std::uint64_t peak = 0, scene = 0, hash = 0;
};

template <class T>
void add(const std::vector<T>& values, Result& result) {
  const std::size_t bytes = values.size() * sizeof(T);
  result.scene += bytes;
  const auto* data = reinterpret_cast<const char*>(values.data());
  for (std::size_t at = 0; at < bytes; at += 4) {
    std::uint32_t word = 0;
    std::memcpy(&word, data + at, 4);
    result.hash = (std::rotl(result.hash, 5) ^ word) * 0x9E3779B97F4A7C15U;
  }
}

Result load_once(const std::string& path, int threads) {
  parallel::Arena arena(threads);
  Result result;
  arena.execute([&] {
    constexpr std::size_t kWarm = std::size_t{1} << 30;  // more than any of the loads takes
    bench::warm_memory(kWarm);
    const std::uint64_t before = files::resident_set();
    bench::peak_memory(true);
    std::vector<std::string> warnings;
    const auto start = std::chrono::steady_clock::now();
    const scenes::Scene scene =
        scenes::load(path, warnings, {.memory = files::MemoryBudget::unlimited()});
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const std::uint64_t peak = bench::peak_memory(false);
    result.peak = peak > before ? peak - before : 0;
    for (const scenes::Mesh& mesh : scene.meshes) {
      add(mesh.positions, result);
      add(mesh.normals, result);
      add(mesh.uvs, result);
      add(mesh.uvs2, result);
      add(mesh.tangents, result);
      add(mesh.colours, result);
      add(mesh.triangles, result);
      result.hash += mesh.material;
    }
    for (const scenes::Texture& texture : scene.textures) add(texture.texels, result);
    result.hash += scene.z_up ? 1 : 0;
    for (const std::string& warning : warnings) {
      for (const char c : warning) result.hash = result.hash * 31 + static_cast<unsigned char>(c);
    }
  });
  return result;
}

// Runs `program` for one file in a process of its own.
Result run(const std::string& program, const std::string& file, int threads) {
  const std::string command =
      "'" + program + "' --once --threads " + std::to_string(threads) + " '" + file + "'";
  std::FILE* output = ::popen(command.c_str(), "r");
  if (output == nullptr) throw std::runtime_error("cannot run " + program);
  Result result;
  unsigned long long peak = 0, scene = 0, hash = 0;
  const int read = std::fscanf(output, "%lf %llu %llu %llx", &result.seconds, &peak, &scene, &hash);
  if (::pclose(output) != 0 || read != 4) throw std::runtime_error("failed: " + command);
  result.peak = peak;
  result.scene = scene;
  result.hash = hash;
  return result;
}

// Values of any kind, little-endian.
class Bytes {
 public:
  explicit Bytes(const std::filesystem::path& path) : file_(path, std::ios::binary) {}
  template <class T>
  void put(const T& value) {
    file_.write(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::ofstream& text() { return file_; }

 private:
  std::ofstream file_;
};

void write_ply(const std::filesystem::path& path, const scenes::Mesh& mesh, bool text) {
  Bytes out(path);
  out.text() << "ply\nformat " << (text ? "ascii" : "binary_little_endian")
             << " 1.0\nelement vertex " << mesh.positions.size()
             << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
             << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const glm::vec3& p : mesh.positions) {
    if (text) {
      out.text() << p.x << ' ' << p.y << ' ' << p.z << '\n';
    } else {
      out.put(p);
    }
  }
  for (const glm::uvec3& t : mesh.triangles) {
    if (text) {
      out.text() << "3 " << t.x << ' ' << t.y << ' ' << t.z << '\n';
    } else {
      out.put(std::uint8_t{3});
      out.put(t);
    }
  }
}

void write_obj(const std::filesystem::path& path, const scenes::Mesh& mesh) {
  std::ofstream out(path);
  for (const glm::vec3& p : mesh.positions) {
    out << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
  }
  for (const glm::uvec3& t : mesh.triangles) {
    out << "f " << t.x + 1 << ' ' << t.y + 1 << ' ' << t.z + 1 << '\n';
  }
}

void write_stl(const std::filesystem::path& path, const scenes::Mesh& mesh) {
  Bytes out(path);
  out.put(std::array<char, 80>{});
  out.put(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const glm::uvec3& t : mesh.triangles) {
    out.put(glm::vec3(0));
    for (int k = 0; k < 3; ++k) out.put(mesh.positions[t[k]]);
    out.put(std::uint16_t{0});
  }
}

// Row by row, as exporters of grids write it: such triangles are put into another order.
scenes::Mesh row_major_terrain(std::uint32_t n) {
  scenes::Mesh mesh;
  for (std::uint32_t y = 0; y < n; ++y) {
    for (std::uint32_t x = 0; x < n; ++x) {
      const auto u = static_cast<float>(x), v = static_cast<float>(y);
      mesh.positions.emplace_back(u, v, 30 * std::sin(u / 50) * std::cos(v / 70));
    }
  }
  for (std::uint32_t y = 0; y + 1 < n; ++y) {
    for (std::uint32_t x = 0; x + 1 < n; ++x) {
      const std::uint32_t i = y * n + x;
      mesh.triangles.emplace_back(i, i + 1, i + n);
      mesh.triangles.emplace_back(i + 1, i + n + 1, i + n);
    }
  }
  return mesh;
}

void make(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const scenes::Scene large = scenes::generate("gen:terrain:1e7");
  scenes::write_glb(folder / "terrain.glb", large);
  write_ply(folder / "terrain.ply", large.meshes[0], false);
  const scenes::Scene small = scenes::generate("gen:terrain:2e6");
  write_obj(folder / "terrain.obj", small.meshes[0]);
  write_ply(folder / "terrain_text.ply", small.meshes[0], true);
  write_stl(folder / "terrain.stl", small.meshes[0]);
  write_ply(folder / "rows.ply", row_major_terrain(2237), false);
}

void compare(const std::vector<std::string>& files, const std::string& self,
             const std::string& other, int threads, int turns) {
  std::printf("%-24s %9s %9s %7s %12s %12s %6s\n", "file", "seconds", "beside", "faster",
              "peak / scene", "beside", "same");
  for (const std::string& file : files) {
    std::vector<double> mine, theirs, faster, peak, their_peak;
    bool same = true;
    run(self, file, threads);  // the file is in the system's cache then
    for (int turn = 0; turn < turns; ++turn) {
      const Result a = run(self, file, threads);
      mine.push_back(a.seconds);
      peak.push_back(static_cast<double>(a.peak) / static_cast<double>(a.scene));
      if (other.empty()) continue;
      const Result b = run(other, file, threads);
      theirs.push_back(b.seconds);
      faster.push_back(b.seconds / a.seconds);
      their_peak.push_back(static_cast<double>(b.peak) / static_cast<double>(b.scene));
      same &= a.hash == b.hash;
    }
    const std::string name = std::filesystem::path(file).filename();
    std::printf("%-24s %9.3f", name.c_str(), bench::median(mine));
    if (!other.empty()) {
      std::printf(" %9.3f %7.2f", bench::median(theirs), bench::median(faster));
      bench::report_ratio(name + ": times faster", bench::median(faster), bench::Better::higher);
    }
    std::printf(" %12.2f", bench::median(peak));
    bench::report_ratio(name + ": peak memory / scene", bench::median(peak), bench::Better::lower,
                        1.3);
    if (!other.empty()) std::printf(" %12.2f %6s", bench::median(their_peak), same ? "yes" : "NO");
    std::printf("\n");
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Seconds and memory that loading scene files takes");
  std::vector<std::string> files;
  std::string other, folder;
  int threads = 2, turns = 5;
  bool once = false;
  app.add_option("FILE", files, "Scene files");
  app.add_option("--make", folder, "Folder to write files to that are measured with");
  app.add_option("--beside", other, "This program of another build");
  app.add_option("--threads", threads, "Threads")->capture_default_str();
  app.add_option("--turns", turns, "Runs of each build")->capture_default_str();
  app.add_flag("--once", once,
               "One run in this process: seconds, bytes at most, of the scene, hash");
  CLI11_PARSE(app, argc, argv);
  if (!folder.empty()) make(folder);
  if (once) {
    const Result r = load_once(files.at(0), threads);
    std::printf("%.6f %llu %llu %llx\n", r.seconds, static_cast<unsigned long long>(r.peak),
                static_cast<unsigned long long>(r.scene), static_cast<unsigned long long>(r.hash));
    return 0;
  }
  compare(files, std::filesystem::read_symlink("/proc/self/exe"), other, threads, turns);
  return 0;
}
