// The memory that a process may take: --memory.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace delray::files {

// A limit of this process's resident set. Whoever is about to allocate much, a reader most of all,
// asks before it does, so that an input cannot unpack to more than the limit however small it is.
// There is no account of what was granted: what is resident counts, whoever holds it, and no longer
// when it is freed. Between asking and filling one thread must not grant what another was granted;
// inputs are read by one.
class MemoryBudget {
 public:
  // Half of machine_memory(): what programs get that were not told otherwise.
  MemoryBudget();
  explicit MemoryBudget(std::uint64_t limit) : limit_(limit) {}
  static MemoryBudget unlimited() { return MemoryBudget(~std::uint64_t{0}); }

  std::uint64_t limit() const { return limit_; }
  // Bytes that may become resident besides those that are. 0 if there are more already.
  std::uint64_t left() const;

  // Throws FileError (memory), which tells the numbers, unless `bytes` more may become resident.
  // `file` and `place` say for what. Small amounts are added up until they are worth looking.
  void require(std::uint64_t bytes, const std::string& file, const std::string& place = "") const;

 private:
  std::uint64_t limit_;
};

// Bytes of memory that the machine has, or the control group of this process may have, whichever is
// less. Does not change while the program runs.
std::uint64_t machine_memory();

// Bytes of this process that are in memory now.
std::uint64_t resident_set();

// "512 bytes", "1.5 MiB": three digits.
std::string bytes_text(std::uint64_t bytes);

// The bytes that "1e6", "500MB" or "2GiB" stand for: K, M, G and T are powers of 1000 before B, of
// 1024 before iB or nothing. 0 for anything else, for less than a byte and for more than 2^63.
std::uint64_t parse_bytes(std::string_view text);

}  // namespace delray::files
