// The bytes of an input of which only ranges are wanted at a time.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "delaunay/files/input.h"

namespace delray::delaunay {

// A regular file, of which ranges are read when they are asked for, or a content in memory.
class ByteSource {
 public:
  // REQUIRES: the content outlives the source.
  explicit ByteSource(const Input& input)
      : name_(input.name),
        content_(input.content),
        size_(input.content.size()),
        memory_(input.memory) {}
  // What was read from a stream.
  ByteSource(std::string name, std::string content, const files::MemoryBudget& memory)
      : name_(std::move(name)),
        owned_(std::make_shared<const std::string>(std::move(content))),
        content_(*owned_),
        size_(content_.size()),
        memory_(memory) {}
  // Throws FileError (input) if there is no such file.
  ByteSource(const std::filesystem::path& path, const files::MemoryBudget& memory);

  const std::string& name() const { return name_; }
  std::uint64_t size() const { return size_; }
  const files::MemoryBudget& memory() const { return memory_; }

  // The bytes [begin, begin + size), in `buffer` where they come from a file. From any thread, with
  // buffers of their own. Throws FileError (input) if the file has become shorter.
  //
  // REQUIRES: begin + size <= size().
  std::string_view read(std::uint64_t begin, std::uint64_t size, std::string& buffer) const;

  // For messages, and for memory that is asked for.
  Input input(std::string_view content = {}) const { return {name_, content, memory_}; }

 private:
  std::string name_;
  std::filesystem::path path_;  // empty: in memory
  std::shared_ptr<const std::string> owned_;
  std::string_view content_;
  std::uint64_t size_ = 0;
  files::MemoryBudget memory_;
};

}  // namespace delray::delaunay
