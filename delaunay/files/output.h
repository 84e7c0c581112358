// A file being written: whole or not at all, in order, formatted in parallel.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "files/atomic_file.h"
#include "parallel/parallel_for.h"

namespace delray::delaunay {

// "-" is standard output. Throws FileError (device) where writing fails.
class Output {
 public:
  explicit Output(const std::filesystem::path& path) : target_(path) {}

  void write(std::string_view bytes) { target_.write(bytes); }
  // Ends the content: what was written is complete, but not yet in its place.
  void close() { target_.complete(); }
  // Puts the file in its place. REQUIRES: closed.
  void commit() { target_.commit(); }

 private:
  files::AtomicFile target_;
};

void append_number(std::string& text, double value);  // the shortest that reads back equal
void append_number(std::string& text, std::uint64_t value);

// The bytes of a number, lowest first.
template <class T>
void append_bytes(std::string& bytes, T value) {
  static_assert(std::endian::native == std::endian::little);
  const auto raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  bytes.append(raw.data(), raw.size());
}

// Writes what format(first, last, text) appends to `text` for runs of [0, n), in order.
template <class F>
void write_runs(Output& output, std::size_t n, F&& format) {
  constexpr std::size_t kBlock = 4096;  // rows: about 1 ms of formatting
  constexpr std::size_t kBlocks = 64;   // held in memory at a time
  std::vector<std::string> blocks(kBlocks);
  for (std::size_t begin = 0; begin < n; begin += kBlock * kBlocks) {
    parallel::parallel_for(0, kBlocks, 1, [&](std::size_t block) {
      blocks[block].clear();
      const std::size_t first = begin + block * kBlock;
      if (first < n) format(first, std::min(n, first + kBlock), blocks[block]);
    });
    for (const std::string& block : blocks) output.write(block);
  }
}

// Writes what format(i, text) appends to `text` for every i of [0, n), in order.
template <class F>
void write_rows(Output& output, std::size_t n, F&& format) {
  write_runs(output, n, [&](std::size_t first, std::size_t last, std::string& text) {
    for (std::size_t i = first; i < last; ++i) format(i, text);
  });
}

}  // namespace delray::delaunay
