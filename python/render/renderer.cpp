// Pictures of scenes: options through the program's own table, frames through its renderers; and
// pictures that grow while Python looks at them.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>

#include "apps/render/options/render_options.h"
#include "apps/render/render_frames.h"
#include "apps/render/render_statistics.h"
#include "apps/render/write_picture.h"
#include "comm/threads.h"
#include "image/hash.h"
#include "image/srgb.h"
#include "parallel/arena.h"
#include "python/render/communicator.h"
#include "python/render/log.h"
#include "python/render/module.h"
#include "python/render/options.h"
#include "python/render/picture.h"
#include "python/render/scene.h"
#include "python/work.h"
#include "scenes/extent.h"

namespace py = pybind11;

namespace delray::python {
namespace {

using Arguments = std::vector<std::string>;

// Options whose results are files, or that are given in another way here.
const Arguments kOfTheProgram = {
    "--output",           "--stats",         "--list",   "--frames",     "--frames-at-once",
    "--turntable",        "--camera-path",   "--wall",   "--checkpoint", "--resume",
    "--checkpoint-every", "--preview-every", "--timeout"};

std::vector<std::string> names_of(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    if (name != "--help") names.push_back(name);
  }
  return names;
}

// A picture of rank 0, as it leaves the renderer: then with the background behind it, and as bytes
// unless floats were asked for.
struct Shown {
  apps::Picture picture;
  std::vector<image::Channel> channels;
  std::string hash;
  apps::Json statistics;
};

py::object arrays_of(Shown&& shown) {
  py::dict channels;
  const auto finish = [&](auto& pixels) -> py::object {
    for (const image::Channel& channel : shown.channels) {
      channels[py::str(channel.name)] =
          py::array_t<float>({pixels.height, pixels.width}, channel.values.data());
    }
    const int width = pixels.width, height = pixels.height;
    return py::make_tuple(array_of(std::move(pixels.colour), width, height),
                          array_of(std::move(pixels.depth), width, height), channels, shown.hash,
                          shown.statistics.is_null() ? std::string() : shown.statistics.dump());
  };
  return std::visit(finish, shown.picture);
}

class Renderer {
 public:
  // A scene in memory, which is copied, or one that the arguments name.
  Renderer(const SceneHandle* scene, const Arguments& arguments, bool floats, MpiRanks* mpi)
      : command_("", "delray render"), mpi_(mpi) {
    apps::add_render_options(command_, request_);
    parse_options(command_, arguments);
    refuse_options(command_, kOfTheProgram, "an option of the program, not of a picture in memory");
    if (scene != nullptr) {
      CLI::App of_scenes;
      apps::SceneInput ignored;
      apps::add_scene_options(of_scenes, ignored);
      refuse_options(command_, names_of(of_scenes),
                     "an option of scenes that are read, as Scene.load() does");
      request_.scene.file.path = "scene";
    }
    request_.output = floats ? "picture.exr" : "picture.png";
    apps::check(command_, request_);
    if (mpi_ != nullptr && request_.launch.ranks > 0)
      throw std::invalid_argument("--ranks: those of the communicator are the ranks");
    ranks_ = std::max(1, request_.launch.ranks);
    threads_ = mpi_ != nullptr ? std::max(1, request_.launch.threads)
                               : apps::threads_per_rank(request_.launch, ranks_);
    std::optional<scenes::Scene> copy;
    if (scene != nullptr) copy = scene->scene;
    using Prepared = std::shared_ptr<const apps::Prepared>;
    prepared_ =
        run({threads_ * ranks_, mpi_ == nullptr}, [&](parallel::Progress& progress) -> Prepared {
          if (copy) return apps::prepare(request_, std::move(*copy));
          return apps::prepare(request_, &progress);
        });
    show_warnings();
  }

  py::object render(const std::string& camera) {
    Shown shown;
    const auto on_rank = [&](comm::Communicator& communicator, parallel::Progress& progress,
                             const std::function<void(apps::Picture &&)>& preview) {
      return frame(communicator, camera, progress, preview);
    };
    if (mpi_ != nullptr) {
      shown = run({threads_}, [&](parallel::Progress& progress) {
        return on_rank(*mpi_->communicator, progress, {});
      });
      show_warnings();
      if (mpi_->communicator->rank() != 0) return py::none();
      return arrays_of(std::move(shown));
    }
    shown = run({1, true},
                [&](parallel::Progress& progress) { return on_threads(camera, progress, {}); });
    show_warnings();
    return arrays_of(std::move(shown));
  }

  // The same on threads of this process, for whom previews are pictures as well. Without the lock.
  Shown on_threads(const std::string& camera, parallel::Progress& progress,
                   const std::function<void(Shown&&)>& preview) {
    Shown shown;
    const parallel::AllowThreads allowed(threads_ * ranks_);
    comm::run_threads(ranks_, threads_, [&](comm::Communicator& communicator) {
      Shown mine = frame(communicator, camera, progress, [&](apps::Picture&& picture) {
        if (preview) preview(finished(std::move(picture), prepared_->camera));
      });
      if (communicator.rank() == 0) shown = std::move(mine);
    });
    return shown;
  }

  // As often as there is something new to see.
  void preview_always() { request_.sampling.preview_every = 1e-6; }
  bool is_raytrace() const { return apps::is_raytrace(request_); }
  bool over_mpi() const { return mpi_ != nullptr; }

 private:
  scenes::Camera camera_of(const std::string& text) const {
    if (text.empty()) return prepared_->camera;
    const float aspect = static_cast<float>(request_.width) / static_cast<float>(request_.height);
    scenes::Camera camera = apps::choose_camera({text, "", request_.camera.clip}, prepared_->scene,
                                                scenes::farthest_points(prepared_->scene), aspect);
    camera.aperture = prepared_->camera.aperture;
    camera.focus = prepared_->camera.focus;
    return camera;
  }

  Shown finished(apps::Picture&& picture, const scenes::Camera& camera) const {
    Shown shown;
    shown.picture = std::move(picture);
    apps::put_background_behind(request_, *prepared_, camera, request_.window, shown.picture);
    if (request_.output.ends_with(".exr")) {
      if (auto* bytes = std::get_if<image::Image8>(&shown.picture))
        shown.picture = image::to_float(*bytes);
      return shown;
    }
    if (auto* floats = std::get_if<image::ImageF>(&shown.picture)) {
      image::Image8 bytes = image::to_8bit(*floats);
      shown.picture = std::move(bytes);
    }
    return shown;
  }

  Shown frame(comm::Communicator& communicator, const std::string& camera_text,
              parallel::Progress& progress, const std::function<void(apps::Picture&&)>& preview) {
    const scenes::Camera camera = camera_of(camera_text);
    apps::FrameRenderer renderer(communicator, *prepared_, request_, &progress);
    if (preview) renderer.set_preview(preview);
    const auto begin = std::chrono::steady_clock::now();
    apps::Frame made = renderer.render(communicator, camera);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    apps::Frames frames;
    frames.statistics = std::move(made.statistics);
    frames.extras = std::move(made.extras);
    frames.seconds.push_back(seconds.count());
    frames.launched = apps::launched(communicator, renderer);
    if (communicator.rank() != 0) return {};
    Shown shown = finished(std::move(made.picture), camera);
    if (const auto* bytes = std::get_if<image::Image8>(&shown.picture)) {
      shown.hash = image::hash(*bytes);
    } else {
      shown.hash = image::hash(image::to_8bit(std::get<image::ImageF>(shown.picture)));
    }
    frames.picture = std::move(shown.picture);
    shown.statistics = apps::render_statistics(request_, *prepared_, frames, shown.hash, 0.0);
    shown.picture = std::move(frames.picture);
    shown.channels = std::move(frames.extras.channels);
    return shown;
  }

  CLI::App command_;
  apps::RenderRequest request_;
  MpiRanks* mpi_;
  int ranks_ = 1, threads_ = 1;
  std::shared_ptr<const apps::Prepared> prepared_;
};

// A picture that grows on a thread of its own; whoever looks gets the newest, and none twice.
class Growing {
 public:
  explicit Growing(Renderer& renderer) : renderer_(renderer) {
    if (!renderer.is_raytrace())
      throw std::invalid_argument("--engine raster: its pictures do not grow");
    if (renderer.over_mpi())
      throw std::invalid_argument("comm: a picture that grows is made by one process");
    renderer.preview_always();
    worker_ = std::jthread([this] { work(); });
  }
  ~Growing() { stop(); }
  Growing(const Growing&) = delete;
  Growing& operator=(const Growing&) = delete;

  // The next picture; none after the last. With the interpreter's lock, which it lets go.
  py::object next() {
    for (;;) {
      std::optional<Shown> shown;
      {
        const py::gil_scoped_release unlocked;
        std::unique_lock lock(mutex_);
        constexpr std::chrono::milliseconds kBetweenLooks{50};
        changed_.wait_for(lock, kBetweenLooks, [&] { return newest_ || is_done_; });
        shown = std::exchange(newest_, {});
        if (!shown && is_done_) break;
      }
      if (shown) return arrays_of(std::move(*shown));
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }
    show_warnings();
    if (failed_) std::rethrow_exception(std::exchange(failed_, {}));
    return py::none();
  }

  void stop() {
    const py::gil_scoped_release unlocked;
    progress_.request_stop();
    if (worker_.joinable()) worker_.join();
  }

 private:
  void work() {
    std::exception_ptr failed;
    try {
      show(renderer_.on_threads("", progress_, [this](Shown&& shown) { show(std::move(shown)); }));
    } catch (const parallel::Interrupted&) {  // what there is stays
    } catch (...) {
      failed = std::current_exception();
    }
    const std::scoped_lock lock(mutex_);
    failed_ = failed;
    is_done_ = true;
    changed_.notify_all();
  }

  void show(Shown&& shown) {
    const std::scoped_lock lock(mutex_);
    newest_ = std::move(shown);
    changed_.notify_all();
  }

  Renderer& renderer_;
  parallel::Progress progress_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<Shown> newest_;
  bool is_done_ = false;
  std::exception_ptr failed_;
  parallel::JoinWorkers join_workers_;
  std::jthread worker_;
};

py::bytes png_of(const py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast>& rgba) {
  if (rgba.ndim() != 3 || rgba.shape(2) != 4 || rgba.size() == 0)
    throw std::invalid_argument("rgba: not an array of (height, width, 4)");
  const auto pixels = static_cast<std::size_t>(rgba.shape(0) * rgba.shape(1));
  std::vector<image::Rgba8> texels(pixels);
  const auto* const from = reinterpret_cast<const image::Rgba8*>(rgba.data());
  for (std::size_t i = 0; i < pixels; ++i) {
    const image::Rgba8 p = from[i];
    if (p.a == 255 || p.a == 0) {
      texels[i] = p;
      continue;
    }
    // PNG's colours are not premultiplied.
    image::RgbaF c = image::to_float(p);
    texels[i] = image::to_8bit(image::RgbaF{c.r / c.a, c.g / c.a, c.b / c.a, 1.0F});
    texels[i].a = p.a;
  }
  const std::vector<std::byte> png =
      image::encode_png(static_cast<int>(rgba.shape(1)), static_cast<int>(rgba.shape(0)), texels);
  return {reinterpret_cast<const char*>(png.data()), png.size()};
}

std::unique_ptr<SceneHandle> load_scene(const Arguments& arguments) {
  CLI::App command("", "delray render");
  apps::SceneInput input;
  apps::add_scene_options(command, input);
  parse_options(command, arguments);
  auto handle = std::make_unique<SceneHandle>();
  handle->scene = run({thread_count({}), true}, [&](parallel::Progress& progress) {
    return apps::load_scene(input, &progress);
  });
  show_warnings();
  if (handle->scene.materials.empty()) handle->scene.materials.emplace_back();
  return handle;
}

}  // namespace

void add_renderer(py::module_& module) {
  using namespace py::literals;
  py::class_<Renderer>(module, "Renderer")
      .def(py::init<const SceneHandle*, const Arguments&, bool, MpiRanks*>(), "scene"_a,
           "arguments"_a, "floats"_a, "communicator"_a, py::keep_alive<1, 5>())
      .def("render", &Renderer::render, "camera"_a);
  py::class_<Growing>(module, "Growing")
      .def(py::init<Renderer&>(), "renderer"_a, py::keep_alive<1, 2>())
      .def("next", &Growing::next)
      .def("stop", &Growing::stop);
  module.def("load_scene", &load_scene, "arguments"_a);
  module.def("encode_png", &png_of, "rgba"_a);
  module.def("render_options", [] {
    CLI::App command;
    apps::RenderRequest request;
    apps::add_render_options(command, request);
    py::dict options;
    for (const CLI::Option* option : command.get_options()) {
      const std::string name = option->get_single_name();
      const bool is_here = !option->get_positional() && !option->get_group().empty() &&
                           name != "help" &&
                           std::ranges::find(kOfTheProgram, "--" + name) == kOfTheProgram.end();
      if (is_here) options[py::str(name)] = option->get_description();
    }
    return options;
  });
}

}  // namespace delray::python
