// The bytes of a file of which only ranges are wanted at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "files/memory_budget.h"

namespace delray::files {

// A regular file, of which ranges are read when they are asked for, or a content in memory. A file
// is read rather than mapped: one that becomes shorter meanwhile is an error, not a signal, and
// what was read counts as memory for no longer than it is used.
class FileBytes {
 public:
  // REQUIRES: the content outlives the object.
  FileBytes(std::string name, std::string_view content, const MemoryBudget& memory)
      : name_(std::move(name)), content_(content), size_(content.size()), memory_(memory) {}
  // What was read from a stream.
  FileBytes(std::string name, std::string content, const MemoryBudget& memory)
      : name_(std::move(name)),
        owned_(std::make_shared<const std::string>(std::move(content))),
        content_(*owned_),
        size_(content_.size()),
        memory_(memory) {}
  // Throws FileError (input) if there is no such file.
  FileBytes(const std::filesystem::path& path, const MemoryBudget& memory);

  const std::string& name() const { return name_; }
  std::uint64_t size() const { return size_; }
  const MemoryBudget& memory() const { return memory_; }
  bool in_memory() const { return path_.empty(); }

  // The bytes [begin, begin + size), in `buffer` where they come from a file. From any thread, with
  // buffers of their own. Throws FileError (input) if the file has become shorter.
  //
  // REQUIRES: begin + size <= size().
  std::string_view read(std::uint64_t begin, std::uint64_t size, std::string& buffer) const;

 private:
  std::string name_;
  std::filesystem::path path_;  // empty: in memory
  std::shared_ptr<const std::string> owned_;
  std::string_view content_;
  std::uint64_t size_ = 0;
  MemoryBudget memory_;
};

}  // namespace delray::files
