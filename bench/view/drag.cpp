// What `delray view` makes of a drag, at the socket, without a browser: the time from a message to
// its frame beside what the frame took to render and encode, processor time at rest, memory.
//
//   build/release/bench/view_drag [--scene gen:terrain:1e6] [--size 1280x720] [--threads 2]
//
// A page sends cameras 60 times a second, whether frames come or not, and acknowledges frames as a
// browser does. A message's frame is the first that shows its camera or a later one.
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using Clock = std::chrono::steady_clock;
using Json = nlohmann::json;

double seconds_between(Clock::time_point a, Clock::time_point b) {
  return std::chrono::duration<double>(b - a).count();
}

// The program, until it is ended.
class Server {
 public:
  Server(const std::string& program, const std::string& scene, const std::string& threads) {
    std::array<int, 2> pipe{};
    if (::pipe2(pipe.data(), O_CLOEXEC) != 0) throw std::runtime_error("pipe");
    std::vector<std::string> words = {program, "view", scene, "--threads", threads, "-q"};
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, pipe[1], STDOUT_FILENO);
    if (::posix_spawn(&process_, program.c_str(), &actions, nullptr, pointers.data(), environ) != 0)
      throw std::runtime_error(program + ": cannot be started");
    posix_spawn_file_actions_destroy(&actions);
    ::close(pipe[1]);
    char c = 0;
    while (::read(pipe[0], &c, 1) == 1 && c != '\n') url_ += c;
    ::close(pipe[0]);
  }
  ~Server() {
    ::kill(process_, SIGINT);
    int status = 0;
    ::waitpid(process_, &status, 0);
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  std::string host() const { return url_.substr(7, url_.find('/', 7) - 7); }
  std::string target() const { return "/socket" + url_.substr(url_.find('?')); }
  // Of all threads, in seconds.
  double processor_time() const {
    std::ifstream file(fmt::format("/proc/{}/stat", process_));
    std::string text((std::istreambuf_iterator<char>(file)), {});
    std::istringstream fields(text.substr(text.rfind(')') + 2));
    std::string skipped;
    for (int i = 0; i < 11; ++i) fields >> skipped;
    double user = 0, system = 0;
    fields >> user >> system;
    return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
  }
  // MiB; "VmRSS" or "VmHWM".
  double memory(const std::string& what) const {
    std::ifstream file(fmt::format("/proc/{}/status", process_));
    for (std::string line; std::getline(file, line);)
      if (line.starts_with(what)) return std::stod(line.substr(what.size() + 1)) / 1024;
    return 0;
  }

 private:
  pid_t process_ = 0;
  std::string url_;
};

struct Arrived {
  Json header;
  Clock::time_point when;
  std::size_t bytes = 0;
};

// A page that notes what comes; one thread reads, another writes.
class Page {
 public:
  explicit Page(const Server& server) {
    const std::string host = server.host();
    const std::size_t colon = host.rfind(':');
    beast::get_lowest_layer(socket_).connect(
        {asio::ip::make_address(host.substr(0, colon)),
         static_cast<std::uint16_t>(std::stoi(host.substr(colon + 1)))});
    beast::get_lowest_layer(socket_).set_option(tcp::no_delay(true));
    socket_.set_option(websocket::stream_base::decorator([&](websocket::request_type& request) {
      request.set(beast::http::field::origin, "http://" + host);
    }));
    socket_.handshake(host, server.target());
    socket_.read_message_max(std::size_t{1} << 28);
  }

  void say(const Json& message) {
    const std::scoped_lock lock(mutex_);
    socket_.text(true);
    socket_.write(asio::buffer(message.dump()));
  }
  // The next message: a frame, or a text whose type is in the header.
  Arrived read() {
    beast::flat_buffer buffer;
    socket_.read(buffer);
    Arrived arrived;
    arrived.when = Clock::now();
    const std::string bytes = beast::buffers_to_string(buffer.data());
    arrived.bytes = bytes.size();
    if (socket_.got_text()) {
      arrived.header = Json::parse(bytes);
      return arrived;
    }
    std::uint32_t length = 0;
    std::memcpy(&length, bytes.data(), sizeof length);
    arrived.header = Json::parse(bytes.substr(sizeof length, length));
    say({{"type", "seen"}, {"frame", arrived.header["frame"]}});
    return arrived;
  }
  Json wait_for(const std::string& type) {
    for (;;) {
      Arrived arrived = read();
      if (arrived.header.value("type", "") == type) return arrived.header;
    }
  }
  Arrived wait_until_complete(std::uint64_t camera) {
    for (;;) {
      Arrived arrived = read();
      if (arrived.header.contains("stage") && arrived.header["complete"] &&
          arrived.header["camera"] == camera) {
        return arrived;
      }
    }
  }

 private:
  asio::io_context context_;
  websocket::stream<tcp::socket> socket_{context_};
  std::mutex mutex_;  // of writing
};

// Around what the camera looks at.
Json turned(const Json& placed, std::uint64_t number, bool moving) {
  const double angle = 0.01 * static_cast<double>(number);
  Json message = placed;
  message["type"] = "camera";
  message["number"] = number;
  message["moving"] = moving;
  const double x = placed["eye"][0].get<double>() - placed["at"][0].get<double>();
  const double y = placed["eye"][1].get<double>() - placed["at"][1].get<double>();
  message["eye"][0] = placed["at"][0].get<double>() + x * std::cos(angle) - y * std::sin(angle);
  message["eye"][1] = placed["at"][1].get<double>() + x * std::sin(angle) + y * std::cos(angle);
  return message;
}

double quantile(std::vector<double> values, double q) {
  std::ranges::sort(values);
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

void report_drag(Page& page, const Json& placed, double seconds, std::uint64_t& number) {
  std::map<std::uint64_t, Clock::time_point> sent;
  std::mutex mutex;
  const std::uint64_t first = number + 1;
  const auto begin = Clock::now();
  std::jthread sender([&] {
    while (seconds_between(begin, Clock::now()) < seconds) {
      const std::uint64_t next = ++number;
      {
        const std::scoped_lock lock(mutex);
        sent[next] = Clock::now();
      }
      page.say(turned(placed, next, true));
      std::this_thread::sleep_until(begin + std::chrono::microseconds(16667) *
                                                static_cast<int>(next - first + 1));
    }
    page.say(turned(placed, number, false));
  });
  std::vector<double> latency, own, ratio, render, encode, bytes, width;
  std::uint64_t shown = first - 1;
  for (;;) {
    const Arrived frame = page.read();
    if (!frame.header.contains("stage")) continue;
    const bool moves = frame.header["stage"] == "moving";
    if (!moves && frame.header["complete"]) break;
    const auto camera = frame.header["camera"].get<std::uint64_t>();
    if (!moves || camera < first) continue;
    render.push_back(frame.header["render_seconds"]);
    encode.push_back(frame.header["encode_seconds"]);
    bytes.push_back(static_cast<double>(frame.bytes));
    width.push_back(frame.header["width"]);
    const double took = render.back() + encode.back();
    const std::scoped_lock lock(mutex);
    for (std::uint64_t i = shown + 1; i <= camera; ++i) {
      latency.push_back(seconds_between(sent.at(i), frame.when));
      ratio.push_back(latency.back() / took);
    }
    shown = camera;
    own.push_back(took);
  }
  sender.join();
  fmt::print("{} messages, {} frames, {:.1f} a second, {:.0f} pixels wide, {:.0f} KB\n",
             latency.size(), own.size(), static_cast<double>(own.size()) / seconds,
             quantile(width, 0.5), quantile(bytes, 0.5) / 1e3);
  fmt::print("a frame's own time: render {:.1f} ms, encode {:.1f} ms (medians)\n",
             quantile(render, 0.5) * 1e3, quantile(encode, 0.5) * 1e3);
  fmt::print("message to frame: median {:.1f} ms, p95 {:.1f} ms\n", quantile(latency, 0.5) * 1e3,
             quantile(latency, 0.95) * 1e3);
  fmt::print("over the frame's own time: median {:.2f}, p95 {:.2f}\n", quantile(ratio, 0.5),
             quantile(ratio, 0.95));
}

void report_processor(const Server& server, const std::string& when, double seconds) {
  const double before = server.processor_time();
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
  fmt::print("processor {}: {:.2f} % of a core\n", when,
             100 * (server.processor_time() - before) / seconds);
}

}  // namespace

int main(int argc, char** argv) {
  std::string program = "build/release/delray", scene = "gen:terrain:1e6", threads = "2";
  int width = 1280, height = 720;
  double seconds = 6;
  CLI::App app("Latency, processor and memory of delray view");
  app.add_option("--program", program);
  app.add_option("--scene", scene);
  app.add_option("--threads", threads);
  app.add_option("--width", width);
  app.add_option("--height", height);
  app.add_option("--seconds", seconds);
  CLI11_PARSE(app, argc, argv);

  const Server server(program, scene, threads);
  Page page(server);
  page.say({{"type", "hello"}, {"width", width}, {"height", height}, {"options", Json::object()}});
  page.wait_for("scene");
  const double loaded = server.memory("VmRSS:");
  const Json placed = page.wait_for("camera");
  page.wait_until_complete(0);
  std::uint64_t number = 0;
  report_drag(page, placed, 1, number);  // warm-up: sizes settle
  fmt::print("\n");
  report_drag(page, placed, seconds, number);
  report_processor(server, "once converged", 5);
  page.say({{"type", "watch"}, {"visible", false}, {"figures", false}});
  report_processor(server, "unwatched", 5);
  fmt::print("memory: {:.0f} MiB with the scene loaded, {:.0f} MiB now, {:.0f} MiB at most\n",
             loaded, server.memory("VmRSS:"), server.memory("VmHWM:"));
}
