// The program `delray`.
#include <fcntl.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <memory>

#include "apps/commands.h"
#include "apps/launch.h"
#include "apps/options/help.h"
#include "apps/options/usage.h"
#include "apps/terminal/progress_bar.h"
#include "files/printable.h"
#include "parallel/stack.h"

namespace {

using namespace delray::apps;

// The text of a log line, which may quote names and texts of files, without anything that a
// terminal would obey.
class PrintableText final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg& message, const std::tm&,
              spdlog::memory_buf_t& to) override {
    const std::string text =
        delray::files::printable({message.payload.data(), message.payload.size()});
    to.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<PrintableText>();
  }
};

// Takes the progress bar away before a line, which it would share otherwise.
class OwnLine final : public spdlog::custom_flag_formatter {
 public:
  void format(const spdlog::details::log_msg&, const std::tm&, spdlog::memory_buf_t& to) override {
    const std::string_view text = before_line();
    to.append(text.data(), text.data() + text.size());
  }
  std::unique_ptr<custom_flag_formatter> clone() const override {
    return std::make_unique<OwnLine>();
  }
};

// Progress, warnings and errors go to stderr: stdout is for results.
void set_up_log() {
  const bool colour = std::getenv("NO_COLOR") == nullptr;
  auto log = spdlog::stderr_color_mt(
      "delray", colour ? spdlog::color_mode::automatic : spdlog::color_mode::never);
  auto formatter = std::make_unique<spdlog::pattern_formatter>();
  formatter->add_flag<PrintableText>('*').add_flag<OwnLine>('~').set_pattern("%~%^%l%$: %*");
  log->set_formatter(std::move(formatter));
  spdlog::set_default_logger(std::move(log));
}

std::string joined(int argc, char** argv) {
  std::string line;
  for (int i = 0; i < argc; ++i) line += (i ? " " : "") + std::string(argv[i]);
  return line;
}

// Where one of the standard streams is closed, the next file that is opened would take its number,
// and get what was meant for the stream. These fail for who uses them, as closed ones do.
void occupy_closed_streams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    if (::fcntl(stream, F_GETFD) < 0) {
      ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    }
  }
}

// Text left in the buffer would be lost unnoticed if it could not be written.
int flushed(int code) {
  errno = 0;
  const bool whole = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (whole || code == kFailed) return code;  // told of already
  std::fprintf(stderr, "error: standard output: cannot write: %s\n",
               std::strerror(errno != 0 ? errno : EIO));
  return code == kDone ? int{kFailed} : code;
}

int run(int argc, char** argv) {
  set_up_log();
  Session session;
  session.command_line = joined(argc, argv);
  find_launcher(session);

  CLI::App program("Delray renders scenes and triangulates points, in parallel.", "delray");
  program.formatter(std::make_shared<HelpFormatter>());
  program.set_help_flag("-h,--help", "Show this page");
  program.set_version_flag("--version", "delray " DELRAY_VERSION, "Show the version");
  program.require_subcommand(1);
  add_info(program, session);
  add_generate(program, session);
  add_triangulate(program, session);
  add_verify(program, session);
  add_render(program, session);
  add_view(program, session);
  add_pack(program, session);
  add_compose(program, session);
  add_compare(program, session);
  add_replay(program, session);
  add_similar(program, session);
  add_completion(program, session);
  add_manual(program, session);
  program.footer(
      "Examples:\n"
      "  delray render gen:spheres -o spheres.png --engine raytrace\n"
      "  delray triangulate points.las -o mesh.ply\n"
      "\ndelray COMMAND --help tells more about a command.\n");
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    program.parse(argc, argv);
    note_options(program, arguments, session);
  } catch (const CLI::ParseError& error) {
    note_options(program, arguments, session);
    const bool asked_for_help = error.get_exit_code() == 0;  // or for the version
    if (asked_for_help && unknown_name(program, arguments).empty()) {
      if (session.first_process) program.exit(error);
      return kDone;
    }
    const std::string why = usage_message(program, arguments, error);
    if (session.first_process) {
      spdlog::error("{}", why);
    } else {
      fail_where_ranks_meet(session, why);
    }
    return session.first_process ? kUsage : kDone;
  }
  return run_guarded(session);
}

int run_and_flush(int argc, char** argv) {
  try {
    return flushed(run(argc, argv));
  } catch (const std::exception& error) {  // before a subcommand began
    std::fprintf(stderr, "error: %s\n", delray::files::printable(error.what()).c_str());
    return kFailed;
  }
}

}  // namespace

int main(int argc, char** argv) {
  occupy_closed_streams();
  std::signal(SIGXFSZ, SIG_IGN);  // writing then fails with EFBIG, which is told of
  return delray::parallel::run_on_own_stack([&] { return run_and_flush(argc, argv); });
}
