// Delray's rasterizer beside Mesa's llvmpipe, same triangles, camera and picture size, lit at the
// vertices (Gouraud), everything warm:
//
//   raster_against_llvmpipe [--width W] [--height H] [--turns N] [--threads N,N...] [--alone]
//                           [SCENE...]
//
// SCENE is a file, gen:KIND[:TRIANGLES[:SEED]], layers:back or layers:front, 32 full-screen
// layers drawn from back to front or from front to back, or points:N, the vertices of a terrain of
// N points, or scattered:N, in a box, as spots of one pixel and a colour; without any, those of
// docs/performance.md. Both must cover the same pixels, but for a few on edges. For each number of
// threads llvmpipe with one and with two threads of its own (the faster median counts) and Delray
// take turns; the table has medians in milliseconds, Delray's over llvmpipe's, and over Delray's
// with the first number of threads, without culling and with it: of faces that look away and of
// hidden clusters. With
// --alone, for profiles, llvmpipe stays away and medians of Delray's phases are shown.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "bench/measure.h"
#include "bench/peers/llvmpipe.h"
#include "bench/ratio.h"
#include "comm/threads.h"
#include "parallel/arena.h"
#include "raster/render.h"
#include "scenes/framing.h"
#include "scenes/generate.h"
#include "scenes/load.h"
#include "scenes/points.h"

namespace {

using namespace delray;

struct Arguments {
  int width = 1920, height = 1080, turns = 9;
  std::vector<int> threads = {1, 2};
  bool alone = false;
  std::vector<std::string> scenes = {
      "gen:terrain:1000000", "gen:terrain:10000000", "gen:field:13000000", "layers:back",
      "layers:front",        "points:10000000",      "scattered:10000000"};
};

// Squares across the view, wider than any frame, at distances 1, 2 ... 32 from the eye.
scenes::Scene layers(bool back_to_front) {
  constexpr int kLayers = 32;
  scenes::Scene scene;
  scene.materials.resize(1);
  for (int i = 0; i < kLayers; ++i) {
    const auto z = static_cast<float>(back_to_front ? kLayers - i : 1 + i);
    const float half = 4 * z;
    scenes::Mesh mesh;
    mesh.positions = {{-half, -half, -z}, {half, -half, -z}, {half, half, -z}, {-half, half, -z}};
    mesh.normals.assign(4, {0, 0, 1});
    mesh.colours.assign(4, glm::vec4(glm::vec3(z / kLayers), 1));
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back({static_cast<std::uint32_t>(i)});
  }
  return scene;
}

// Spots of one pixel, unlit, which come in the order of the terrain's rows or in none at all.
scenes::Scene points(const std::string& count, bool scattered, scenes::Camera& camera,
                     float aspect) {
  const auto n = static_cast<std::size_t>(std::stod(count));
  scenes::Scene scene;
  scenes::Mesh mesh;
  if (scattered) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> both(-1, 1);
    for (std::size_t i = 0; i < n; ++i)
      mesh.positions.emplace_back(both(random), both(random), both(random));
  } else {
    mesh.positions = scenes::generate("gen:terrain:" + std::to_string(2 * n)).meshes[0].positions;
  }
  for (const glm::vec3& p : mesh.positions)
    mesh.colours.emplace_back(glm::fract(p * 7.0F + 0.5F), 1.0F);
  scenes::make_points(mesh, {scenes::Shape::Kind::point, true, 0.5F});
  scene.meshes.push_back(std::move(mesh));
  scene.instances.push_back({});
  scene.materials.resize(1);
  scene.materials[0].unlit = true;
  scene.materials[0].base_colour = glm::vec4(1);
  camera = scenes::camera_around(scene, "default", aspect);
  return scene;
}

scenes::Scene make_scene(const std::string& name, scenes::Camera& camera, float aspect) {
  if (name.starts_with("layers:")) {
    camera.eye = {0, 0, 0};
    camera.at = {0, 0, -1};
    camera.near = 0.1F;
    return layers(name == "layers:back");
  }
  for (const std::string kind : {"points:", "scattered:"})
    if (name.starts_with(kind))
      return points(name.substr(kind.size()), kind == "scattered:", camera, aspect);
  std::vector<std::string> warnings;
  scenes::Scene scene =
      scenes::is_generated(name) ? scenes::generate(name) : scenes::load(name, warnings);
  camera = !scene.cameras.empty() ? scene.cameras.front()
                                  : scenes::camera_around(scene, "default", aspect);
  return scene;
}

// Frames of a scene on one rank whose threads stay alive.
class Frames {
 public:
  Frames(comm::Communicator& communicator, const scenes::Scene& scene, const scenes::Camera& camera,
         const Arguments& arguments)
      : communicator_(communicator), renderer_(scene), camera_(camera) {
    options_.width = arguments.width;
    options_.height = arguments.height;
    options_.lighting = raster::Lighting::gouraud;
  }

  raster::Result render(bool cull) {
    options_.cull_single_sided = cull;
    options_.skip_hidden_clusters = cull;
    return renderer_.render(communicator_, camera_, options_);
  }
  // Draws into the memory of the last picture, as llvmpipe does all the time.
  double seconds(bool cull) {
    raster::Result result;
    const double seconds = bench::seconds_of([&] {
      result = render(cull);
      return 0;
    });
    phases_ = result.statistics.phases;
    renderer_.recycle(std::move(result.picture));
    return seconds;
  }
  const raster::Phases& phases() const { return phases_; }

 private:
  comm::Communicator& communicator_;
  raster::Renderer renderer_;
  scenes::Camera camera_;
  raster::RenderOptions options_;
  raster::Phases phases_;  // of the frame that was timed last
};

// How many pixels only one of both covers.
std::size_t differences(const raster::Picture& picture, const std::vector<std::uint8_t>& covered) {
  const auto& image = std::get<image::Image8>(picture);
  std::size_t result = 0;
  for (std::size_t i = 0; i < covered.size(); ++i) {
    result += (image.colour.data()[i].a != 0) != (covered[i] != 0);
  }
  return result;
}

// Medians of the turns of all sides.
struct Medians {
  double peer;                 // of the faster number of llvmpipe's threads
  std::array<double, 2> ours;  // without and with culling
};

Medians take_turns(Frames& frames, std::array<std::unique_ptr<bench::Llvmpipe>, 2>& peers,
                   int turns) {
  std::array<std::vector<double>, 2> peer, ours;
  for (const bool cull : {false, true}) frames.seconds(cull);
  for (int turn = 0; turn < turns; ++turn) {
    for (int i = 0; i < 2; ++i) peer[i].push_back(peers[i]->render());
    for (const bool cull : {false, true}) ours[cull].push_back(frames.seconds(cull));
  }
  return {std::min(bench::median(peer[0]), bench::median(peer[1])),
          {bench::median(ours[0]), bench::median(ours[1])}};
}

constexpr double kMilli = 1e3;

void show_phases(Frames& frames, const std::string& name, int threads, int turns) {
  for (const bool cull : {false, true}) {
    std::array<std::vector<double>, 5> times;
    frames.seconds(cull);
    for (int turn = 0; turn < turns; ++turn) {
      times[0].push_back(frames.seconds(cull));
      const raster::Phases& phases = frames.phases();
      times[1].push_back(phases.transform);
      times[2].push_back(phases.bin);
      times[3].push_back(phases.rasterize);
      times[4].push_back(phases.shade);
    }
    std::printf("%-24s %7d %5s", name.c_str(), threads, cull ? "yes" : "no");
    for (const auto& time : times) std::printf(" %10.2f", bench::median(time) * kMilli);
    std::printf("\n");
  }
}

bool compare(const std::string& path, const Arguments& arguments) {
  const std::string name = path.substr(path.rfind('/') + 1);
  scenes::Camera camera;
  scenes::Scene scene = make_scene(
      path, camera, static_cast<float>(arguments.width) / static_cast<float>(arguments.height));
  complete(scene, camera);
  // Culling is to be compared too, so no face may need both of its sides.
  for (scenes::Material& material : scene.materials) material.double_sided = false;
  if (arguments.alone) {
    for (const int threads : arguments.threads) {
      comm::run_threads(1, threads, [&](comm::Communicator& communicator) {
        Frames frames(communicator, scene, camera, arguments);
        show_phases(frames, name, threads, arguments.turns);
      });
    }
    return true;
  }
  const scenes::View view = scenes::make_view(camera, arguments.width, arguments.height);

  std::array<std::unique_ptr<bench::Llvmpipe>, 2> peers;
  for (int i = 0; i < 2; ++i) {
    peers[i] = std::make_unique<bench::Llvmpipe>(scene, view, i + 1);
    peers[i]->render();
  }
  std::vector<Medians> medians;
  std::size_t different = 0;
  for (const int threads : arguments.threads) {
    comm::run_threads(1, threads, [&](comm::Communicator& communicator) {
      Frames frames(communicator, scene, camera, arguments);
      different = differences(frames.render(false).picture, peers[0]->coverage());
      medians.push_back(take_turns(frames, peers, arguments.turns));
    });
  }
  // One pixel of so many may differ; of spots all are on edges.
  const std::size_t edges = scene.meshes[0].has_triangles() ? 2000 : 500;
  if (different > static_cast<std::size_t>(arguments.width) * arguments.height / edges) {
    std::printf("%-24s %zu pixels are covered by one and not by the other\n", name.c_str(),
                different);
    return false;
  }
  for (const bool cull : {false, true}) {
    for (std::size_t i = 0; i < medians.size(); ++i) {
      const double seconds = medians[i].ours[cull];
      std::printf("%-24s %10zu %7d %5s %10.2f %10.2f %8.3f %10.3f\n", name.c_str(),
                  static_cast<std::size_t>(scenes::first_primitives(scene).back()),
                  arguments.threads[i], cull ? "yes" : "no", medians[i].peer * kMilli,
                  seconds * kMilli, seconds / medians[i].peer, seconds / medians[0].ours[cull]);
      bench::report_ratio(
          name + (cull ? ", culling, " : ", ") + bench::thread_count(arguments.threads[i]),
          seconds / medians[i].peer);
    }
  }
  std::fflush(stdout);
  return true;
}

}  // namespace

int main(int count, char** words) {
  Arguments arguments;
  CLI::App app("Delray's rasterizer beside llvmpipe");
  app.add_option("--width", arguments.width)->check(CLI::PositiveNumber);
  app.add_option("--height", arguments.height)->check(CLI::PositiveNumber);
  app.add_option("--turns", arguments.turns)->check(CLI::PositiveNumber);
  app.add_option("--threads", arguments.threads)->delimiter(',')->check(CLI::PositiveNumber);
  app.add_flag("--alone", arguments.alone);
  app.add_option("scenes", arguments.scenes);
  CLI11_PARSE(app, count, words);
  try {
    if (arguments.alone) {
      std::printf("%-24s %7s %5s %10s %10s %10s %10s %10s\n", "scene", "threads", "cull",
                  "frame ms", "transform", "bin", "rasterize", "shade");
    } else {
      std::printf("%-24s %10s %7s %5s %10s %10s %8s %10s\n", "scene", "primitives", "threads",
                  "cull", "llvmpipe", "delray ms", "ratio", "over first");
    }
    bool good = true;
    for (const std::string& scene : arguments.scenes) good &= compare(scene, arguments);
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
}
