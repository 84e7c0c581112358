#include "delaunay/internal/output.h"

#include <cerrno>
#include <charconv>
#include <cstring>

#include "files/error.h"

namespace delray::delaunay {

Output::Output(const std::filesystem::path& path)
    : name_(path == "-" ? "standard output" : path.string()), file_(stdout) {
  if (path == "-") return;
  target_.emplace(path);
  file_ = std::fopen(target_->temporary().c_str(), "wb");
  if (!file_) fail();
}

Output::~Output() {
  if (file_ && target_) std::fclose(file_);
}

void Output::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) fail();
}

void Output::close() {
  std::FILE* file = file_;
  if (!target_) {
    if (std::fflush(file) != 0) fail();
    return;
  }
  file_ = nullptr;
  if (std::fclose(file) != 0) fail();
}

void Output::commit() {
  if (target_) target_->commit();
}

void Output::fail() const {
  throw files::FileError(files::Cause::device, name_, "",
                         std::string("cannot write: ") + std::strerror(errno));
}

void append_number(std::string& text, double value) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
}

void append_number(std::string& text, std::uint64_t value) {
  std::array<char, 20> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr;
  text.append(digits.data(), end);
}

}  // namespace delray::delaunay
