// A sink of spdlog that any thread may write to, without the interpreter's lock.
#include "python/render/log.h"

#include <pybind11/pybind11.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace delray::python {
namespace {

class Kept final : public spdlog::sinks::base_sink<std::mutex> {
 public:
  std::vector<std::string> take() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(messages_, {});
  }

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    messages_.emplace_back(message.payload.data(), message.payload.size());
  }
  void flush_() override {}

 private:
  std::vector<std::string> messages_;
};

const std::shared_ptr<Kept>& kept() {
  static const auto sink = std::make_shared<Kept>();
  return sink;
}

}  // namespace

void log_to_python() {
  const auto logger = std::make_shared<spdlog::logger>("delray", kept());
  logger->set_level(spdlog::level::warn);
  spdlog::set_default_logger(logger);
}

void show_warnings() {
  for (const std::string& message : kept()->take()) {
    if (PyErr_WarnEx(PyExc_UserWarning, message.c_str(), 2) != 0)
      throw pybind11::error_already_set();
  }
}

}  // namespace delray::python
