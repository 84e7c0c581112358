// Compares hashes of all facts by one all-reduce of minima: a hash and its complement, whose
// minimum is the complement of the maximum, so all are equal if both bounds agree. Only if they
// differ does rank 0 broadcast its facts, and every rank looks for its first difference.
#include "comm/handshake.h"

#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <exception>
#include <functional>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "comm/agree_on_failure.h"
#include "comm/collectives.h"

namespace delray::comm {
namespace {

// Where a rank runs, which is no fact.
std::string host() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "unknown";
}

void append(std::string& text, std::string_view part) {
  const std::uint64_t size = part.size();
  text.append(reinterpret_cast<const char*>(&size), sizeof size);
  text += part;
}

std::string encode(std::span<const Fact> facts) {
  std::string text;
  for (const Fact& fact : facts) {
    append(text, fact.what);
    append(text, fact.value);
  }
  return text;
}

// Of another rank, which may be another program: whatever the bytes are.
std::string take(std::string_view& text) {
  std::uint64_t size = 0;
  if (text.size() < sizeof size) return {};
  std::memcpy(&size, text.data(), sizeof size);
  text.remove_prefix(sizeof size);
  const std::string part(text.substr(0, size));
  text.remove_prefix(part.size());
  return part;
}

std::vector<Fact> decode(std::string_view text) {
  std::vector<Fact> facts;
  while (!text.empty()) {
    Fact& fact = facts.emplace_back();
    fact.what = take(text);
    fact.value = take(text);
  }
  return facts;
}

std::string value_of(const std::string& what, std::span<const Fact> facts) {
  const auto at = std::ranges::find(facts, what, &Fact::what);
  return at == facts.end() || at->value.empty() ? "nothing" : at->value;
}

bool all_are_equal(Communicator& communicator, const std::string& text) {
  const XXH128_hash_t hash = XXH3_128bits(text.data(), text.size());
  const std::array<std::uint64_t, 4> least_and_most =
      all_reduce_value(communicator, std::array{hash.high64, hash.low64, ~hash.high64, ~hash.low64},
                       [](const auto& a, const auto& b) {
                         auto least = a;
                         for (std::size_t i = 0; i < least.size(); ++i) {
                           least[i] = std::min(a[i], b[i]);
                         }
                         return least;
                       });
  return least_and_most[0] == ~least_and_most[2] && least_and_most[1] == ~least_and_most[3];
}

}  // namespace

void handshake(Communicator& communicator, std::span<const Fact> facts) {
  if (communicator.size() == 1 || all_are_equal(communicator, encode(facts))) return;
  const bool first = communicator.rank() == 0;
  const auto told = [&](const std::string& mine) {
    const Buffer text =
        broadcast(communicator, 0, first ? Buffer::of(std::span<const char>(mine)) : Buffer());
    return std::string(reinterpret_cast<const char*>(text.data()), text.size());
  };
  const std::string first_host = told(host());
  const std::vector<Fact> others = decode(told(encode(facts)));
  std::string what;
  for (const std::span<const Fact> list : {std::span<const Fact>(others), facts}) {
    for (const Fact& fact : list) {
      if (what.empty() && value_of(fact.what, others) != value_of(fact.what, facts))
        what = fact.what;
    }
  }
  const int differ =
      all_reduce_value(communicator, what.empty() ? 0 : 1, [](int a, int b) { return a + b; });
  std::exception_ptr failure;
  if (!what.empty()) {
    std::string text = "ranks differ in " + what + ": rank 0 (" + first_host + ") has " +
                       value_of(what, others) + ", rank " + std::to_string(communicator.rank()) +
                       " (" + host() + ") has " + value_of(what, facts);
    if (differ > 1) text += "; " + std::to_string(differ - 1) + " more differ";
    failure = std::make_exception_ptr(std::invalid_argument(text));
  }
  agree_on_failure(communicator, failure, Phase::load);
}

}  // namespace delray::comm
