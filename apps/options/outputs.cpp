// Compares what a command reads with what it is to write.
#include "apps/options/outputs.h"

#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>

#include "apps/session.h"
#include "files/error.h"
#include "files/output_path.h"

namespace delray::apps {
namespace {

namespace fs = std::filesystem;

// A .node and an .ele file are read and written together.
std::vector<fs::path> with_companion(const std::string& file) {
  const fs::path path(file), suffix = path.extension();
  if (suffix == ".node") return {path, fs::path(path).replace_extension(".ele")};
  if (suffix == ".ele") return {path, fs::path(path).replace_extension(".node")};
  return {path};
}

// Behind links, as far as anything is there.
fs::path resolved(const fs::path& path) {
  try {
    return files::output_path(path).path;
  } catch (const files::FileError&) {
    return path;  // told of when it is written
  }
}

// "-", /dev/stdout and links to it.
bool is_standard_output(const fs::path& path) {
  try {
    return files::output_path(path).descriptor == STDOUT_FILENO;
  } catch (const files::FileError&) {
    return false;
  }
}

bool overlap(const std::string& output, const std::string& other, int stream) {
  for (const fs::path& a : with_companion(output)) {
    for (const fs::path& b : with_companion(other)) {
      if (files::is_same_file({resolved(a), 1}, {b == "-" ? b : resolved(b), stream})) return true;
    }
  }
  return false;
}

}  // namespace

void refuse_overwriting(const std::vector<OutputFile>& outputs,
                        const std::vector<std::string>& inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const OutputFile& output = outputs[i];
    if (output.path.empty()) continue;
    for (const std::string& input : inputs) {
      if (!input.empty() && overlap(output.path, input, 0)) {
        throw UsageError(fmt::format("{}: '{}' would overwrite the input, {}", output.option,
                                     output.path, input == "-" ? "standard input" : input));
      }
    }
    for (std::size_t k = 0; k < i; ++k) {
      const OutputFile& other = outputs[k];
      if (other.path.empty()) continue;
      const bool mixed = is_standard_output(output.path) && is_standard_output(other.path);
      if (mixed || overlap(output.path, other.path, 1)) {
        throw UsageError(
            fmt::format("{}: '{}' is where {} goes too", output.option, output.path, other.option));
      }
    }
  }
}

void refuse_terminal(const std::string& picture) {
  if (picture == "-" && ::isatty(STDOUT_FILENO) != 0) {
    throw UsageError("-o -: standard output is a terminal, which shows no pictures");
  }
}

void check_outputs(const std::vector<OutputFile>& outputs, const std::vector<std::string>& inputs) {
  refuse_overwriting(outputs, inputs);
  for (const OutputFile& output : outputs) files::check_writable(output.path);
}

}  // namespace delray::apps
