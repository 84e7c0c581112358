// The one exception for bad input, failing devices and inputs that are too large; only apps/
// catches it.
#pragma once

#include <stdexcept>
#include <string>

namespace delray::files {

// Why a file cannot be used, and the exit code that the program ends with.
enum class Cause {
  input,   // the content of a file or stream is not what it should be: exit code 3
  device,  // reading or writing failed: disk full, no such file to write to: exit code 1
  memory,  // takes more memory than the program may have (MemoryBudget): exit code 1
};

// The one exception for bad input and failing devices: names the file and the place in it.
class FileError : public std::runtime_error {
 public:
  // `file` is the name as the user gave it ("-" for a stream), `place` a line, byte or element
  // ("line 12", "byte 1040", "accessor 3"), empty where there is none.
  FileError(Cause cause, std::string file, std::string place, const std::string& what)
      : std::runtime_error(without_end(file + (place.empty() ? "" : ": " + place) + ": " + what)),
        cause_(cause),
        file_(std::move(file)),
        place_(std::move(place)) {}

  Cause cause() const { return cause_; }
  const std::string& file() const { return file_; }
  const std::string& place() const { return place_; }

 private:
  // what() would end at a zero byte, which a name in a file may hold.
  static std::string without_end(std::string text) {
    for (std::size_t at = 0; (at = text.find('\0', at)) != std::string::npos;) {
      text.replace(at, 1, "\\x00");
    }
    return text;
  }

  Cause cause_;
  std::string file_, place_;
};

}  // namespace delray::files
