// Starts the user's browser.
#pragma once

#include <filesystem>
#include <string>
#include <thread>

#include "parallel/progress.h"

namespace delray::apps::view {

// Opens an address with xdg-open while it lives. The address is handed over in a file that nobody
// else may read, not on a command line, which everybody sees. Where it cannot be opened, a warning
// says so.
class OpenBrowser {
 public:
  explicit OpenBrowser(const std::string& url);
  ~OpenBrowser();
  OpenBrowser(const OpenBrowser&) = delete;
  OpenBrowser& operator=(const OpenBrowser&) = delete;

 private:
  parallel::Progress stop_;
  std::filesystem::path folder_;
  std::thread thread_;
};

}  // namespace delray::apps::view
