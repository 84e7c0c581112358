// A page that leads to the address, in a folder of its own.
#include "apps/view/open_browser.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "apps/render/run_command.h"

namespace delray::apps::view {
namespace {

namespace fs = std::filesystem;

// Only its owner may look into it.
fs::path make_folder() {
  std::string name = (fs::temp_directory_path() / "delray-view-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    throw std::system_error(errno, std::generic_category(), name);
  return name;
}

void write_page(const fs::path& path, const std::string& url) {
  const std::string page = fmt::format(
      "<!DOCTYPE html><meta charset=\"utf-8\"><meta http-equiv=\"refresh\" "
      "content=\"0;url={0}\"><title>delray view</title><a href=\"{0}\">delray view</a>\n",
      url);
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
  const bool whole =
      file >= 0 && ::write(file, page.data(), page.size()) == static_cast<ssize_t>(page.size());
  const int error = errno;
  if (file >= 0) ::close(file);
  if (!whole) throw std::system_error(error, std::generic_category(), path.string());
}

}  // namespace

OpenBrowser::OpenBrowser(const std::string& url) {
  const fs::path opener = find_program("xdg-open");
  if (opener.empty()) {
    spdlog::warn("--open: xdg-open is not installed; open the address yourself");
    return;
  }
  try {
    folder_ = make_folder();
    write_page(folder_ / "view.html", url);
    thread_ = std::thread([this, opener] {
      try {
        const CommandResult result = run_command(opener, {"view.html"}, folder_, &stop_);
        if (result.exit_code != 0) spdlog::warn("--open: xdg-open failed: {}", result.errors);
      } catch (const std::exception& error) {
        if (!stop_.stop_requested()) spdlog::warn("--open: {}", error.what());
      }
    });
  } catch (const std::system_error& error) {
    spdlog::warn("--open: {}", error.what());
  }
}

OpenBrowser::~OpenBrowser() {
  stop_.request_stop();
  if (thread_.joinable()) thread_.join();
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

}  // namespace delray::apps::view
