// Reads members one by one; what is left over is unknown. Nothing in the file is believed: every
// number has its range, and an option that the topology does not have is refused.
#include "comm/network_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "files/error.h"
#include "files/find_named.h"
#include "files/read_file.h"

namespace delray::comm {
namespace {

using NetworkJson = nlohmann::ordered_json;

constexpr const char* kSchema = "delray.network/1";
constexpr double kMostSeconds = 3600, kMostBytesPerSecond = 1e18;
constexpr int kMostSide = 1 << 20;
constexpr std::size_t kMostDimensions = 8;

std::string listed_topologies() {
  std::string names;
  for (const TopologyKind& kind : topologies())
    names += (names.empty() ? "" : ", ") + std::string(kind.name);
  return names;
}

class Members {
 public:
  Members(const NetworkJson& object, const std::string& file) : object_(object), file_(file) {}

  [[noreturn]] void fail(const std::string& key, const std::string& what) const {
    throw files::FileError(files::Cause::input, file_, "\"" + key + "\"", what);
  }
  bool has(const char* key) const { return object_.contains(key); }

  std::string text(const char* key, const std::string& otherwise) {
    const NetworkJson* value = find(key);
    if (value == nullptr) return otherwise;
    if (!value->is_string()) fail(key, "is no text");
    return value->get<std::string>();
  }
  // Above or, with `zero`, from 0 up to `most`.
  double number(const char* key, double most, bool zero) {
    const NetworkJson* value = find(key);
    if (value == nullptr) fail(key, "is missing");
    const double got = value->is_number() ? value->get<double>() : -1;
    if (!(got > 0 || (zero && got == 0)) || got > most) {
      fail(key, "is no number " + std::string(zero ? "from 0" : "above 0") + " to " +
                    NetworkJson(most).dump());
    }
    return got;
  }
  double number_or(const char* key, double otherwise, double most, bool zero) {
    return has(key) ? number(key, most, zero) : otherwise;
  }
  int count_or(const char* key, int otherwise, int least, int most) {
    const NetworkJson* value = find(key);
    return value == nullptr ? otherwise : count(*value, key, least, most);
  }
  std::vector<int> counts(const char* key) {
    const NetworkJson* value = find(key);
    if (value == nullptr) return {};
    if (!value->is_array() || value->empty() || value->size() > kMostDimensions)
      fail(key, "is no list of 1 to 8 sides");
    std::vector<int> result;
    for (const NetworkJson& one : *value)
      result.push_back(count(one, key + ("[" + std::to_string(result.size()) + "]"), 1, kMostSide));
    return result;
  }
  void refuse_others() const {
    for (const auto& [key, value] : object_.items())
      if (!known_.contains(key)) fail(key, "is not known");
  }

 private:
  const NetworkJson* find(const char* key) {
    known_.insert(key);
    const auto at = object_.find(key);
    return at == object_.end() ? nullptr : &*at;
  }
  int count(const NetworkJson& value, const std::string& key, int least, int most) const {
    const bool fits = value.is_number_unsigned() &&
                      value.get<std::uint64_t>() >= static_cast<std::uint64_t>(least) &&
                      value.get<std::uint64_t>() <= static_cast<std::uint64_t>(most);
    if (!fits) {
      fail(key, "is no whole number from " + std::to_string(least) + " to " + std::to_string(most));
    }
    return value.get<int>();
  }

  const NetworkJson& object_;
  const std::string& file_;
  std::set<std::string, std::less<>> known_;
};

Topology topology_of(Members& members) {
  const std::string name = members.text("topology", "");
  const TopologyKind* kind = files::find_named(topologies(), name);
  if (kind == nullptr) {
    members.fail("topology", (members.has("topology") ? "'" + name + "' is not one of "
                                                      : "is missing: one of ") +
                                 listed_topologies());
  }
  const auto refuse_unless = [&](bool has, const char* key) {
    if (!has && members.has(key)) members.fail(key, "has no effect on a " + name);
  };
  refuse_unless(kind->has_sides, "sides");
  refuse_unless(kind->has_arity, "arity");
  refuse_unless(kind->has_channels, "channels");
  refuse_unless(kind->has_routes, "hop_latency");
  Topology topology;
  topology.shape = kind->shape;
  topology.sides = members.counts("sides");
  topology.arity = members.count_or("arity", topology.arity, 2, 1 << 12);
  topology.channels = members.count_or("channels", topology.channels, 1, 1 << 16);
  return topology;
}

NetworkJson parse_json(std::string_view text, const std::string& file) {
  try {
    return NetworkJson::parse(text);
  } catch (const NetworkJson::parse_error& error) {
    const std::string_view before = text.substr(0, std::min(text.size(), error.byte));
    throw files::FileError(files::Cause::input, file,
                           "line " + std::to_string(1 + std::ranges::count(before, '\n')),
                           "not JSON");
  } catch (const NetworkJson::exception&) {
    throw files::FileError(files::Cause::input, file, "", "a number out of range");
  }
}

}  // namespace

NamedNetwork parse_network(std::string_view text, const std::string& file) {
  const NetworkJson json = parse_json(text, file);
  if (!json.is_object()) throw files::FileError(files::Cause::input, file, "", "is no JSON object");
  Members members(json, file);
  if (const std::string schema = members.text("schema", ""); schema != kSchema)
    members.fail("schema", "is not \"" + std::string(kSchema) + "\"");
  NamedNetwork named;
  named.name = members.text("name", std::filesystem::path(file).stem().string());
  if (named.name.empty() || named.name.size() > 200)
    members.fail("name", "has 1 to 200 characters");
  Network& network = named.network;
  network.topology = topology_of(members);
  named.description = members.text("description", kind_of(network.topology.shape).name);
  network.latency = members.number("latency", kMostSeconds, true);
  network.hop_seconds = members.number_or("hop_latency", 0, kMostSeconds, true);
  network.overhead = members.number("overhead", kMostSeconds, true);
  network.seconds_per_byte = 1 / members.number("bytes_per_second", kMostBytesPerSecond, false);
  const double copied = members.number_or("copy_bytes_per_second", 0, kMostBytesPerSecond, false);
  network.copy_seconds_per_byte = copied > 0 ? 1 / copied : 0;
  network.shared_cores = members.count_or("shared_cores", 0, 1, 1 << 20);
  members.refuse_others();
  return named;
}

NamedNetwork read_network(const std::string& file) {
  return parse_network(files::read_file(file), file);
}

std::string network_text(const NamedNetwork& named) {
  const Network& network = named.network;
  const Topology& topology = network.topology;
  const TopologyKind& kind = kind_of(topology.shape);
  NetworkJson json = {{"schema", kSchema},
                      {"name", named.name},
                      {"description", named.description},
                      {"topology", kind.name},
                      {"latency", network.latency},
                      {"overhead", network.overhead},
                      {"bytes_per_second", 1 / network.seconds_per_byte}};
  if (network.copy_seconds_per_byte > 0)
    json["copy_bytes_per_second"] = 1 / network.copy_seconds_per_byte;
  if (!topology.sides.empty()) json["sides"] = topology.sides;
  if (kind.has_arity) json["arity"] = topology.arity;
  if (kind.has_channels) json["channels"] = topology.channels;
  if (kind.has_routes) json["hop_latency"] = network.hop_seconds;
  if (network.shared_cores > 0) json["shared_cores"] = network.shared_cores;
  return json.dump();
}

NamedNetwork network_of(const std::string& name_or_file) {
  if (const NamedNetwork* named = find_network(name_or_file)) return *named;
  if (!name_or_file.ends_with(".json") && name_or_file.find('/') == std::string::npos &&
      !std::filesystem::exists(name_or_file)) {
    std::string names;
    for (const NamedNetwork& named : networks()) names += ", " + named.name;
    throw files::FileError(files::Cause::input, name_or_file, "",
                           "is neither a file nor one of the networks" + names.substr(1));
  }
  return read_network(name_or_file);
}

}  // namespace delray::comm
