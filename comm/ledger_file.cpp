// An event is an array: its kind, phase, round, peer, tag, amount, begin and end; work has the name
// of its unit for a kind and neither peer nor tag. Nothing read is believed: names are looked up,
// numbers have ranges, and what is received must have been sent, so that a replay ends.
#include "comm/ledger_file.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "comm/network_file.h"
#include "files/error.h"
#include "files/read_file.h"

namespace delray::comm {
namespace {

using LedgerJson = nlohmann::json;

constexpr const char* kLedgerSchema = "delray.ledger/1";
constexpr int kMostRanks = 1 << 16;
constexpr std::int32_t kMostRounds = std::int32_t{1} << 30;
constexpr double kMostNanoseconds = 1e18;  // 31 years
constexpr std::size_t kEventFields = 8;

const char* kind_name(const Event& event) {
  switch (event.kind) {
    case Event::Kind::send:
      return event.is_repeated ? "send on" : "send";
    case Event::Kind::receive:
      return "receive";
    case Event::Kind::mark:
      return "mark";
    case Event::Kind::work:
      break;
  }
  return name(event.work);
}

std::int64_t nanoseconds(double seconds) { return std::llround(seconds * 1e9); }

std::string place_of_event(std::size_t rank, std::size_t event) {
  return "rank " + std::to_string(rank) + ", event " + std::to_string(event);
}

class LedgerReader {
 public:
  explicit LedgerReader(const std::string& file) : file_(file) {}

  RecordedRun read(std::string_view text) {
    const LedgerJson json = parse(text);
    if (!json.is_object()) fail("", "is no JSON object");
    const std::string schema = json.value("schema", LedgerJson()).is_string()
                                   ? json["schema"].get<std::string>()
                                   : std::string();
    if (schema != kLedgerSchema)
      fail("\"schema\"", "is not \"" + std::string(kLedgerSchema) + "\"");
    RecordedRun run;
    if (const auto program = json.find("program"); program != json.end() && program->is_string())
      run.program = program->get<std::string>();
    run.seconds = number(json, "seconds", "\"seconds\"", kMostNanoseconds * 1e-9);
    if (json.contains("other_programs"))
      run.other_programs = number(json, "other_programs", "\"other_programs\"", 1 << 20);
    const auto machine = json.find("machine");
    if (machine == json.end()) fail("\"machine\"", "is missing");
    run.machine = parse_network(machine->dump(), file_ + ": \"machine\"");
    const auto ranks = json.find("ranks");
    if (ranks == json.end() || !ranks->is_array() || ranks->empty() || ranks->size() > kMostRanks)
      fail("\"ranks\"", "is no list of 1 to " + std::to_string(kMostRanks) + " ranks");
    count_ = static_cast<int>(ranks->size());
    for (const LedgerJson& events : *ranks) run.ledger.ranks.push_back(read_rank(events));
    check_messages(run.ledger);
    return run;
  }

 private:
  [[noreturn]] void fail(const std::string& place, const std::string& what) const {
    throw files::FileError(files::Cause::input, file_, place, what);
  }

  LedgerJson parse(std::string_view text) const {
    try {
      return LedgerJson::parse(text);
    } catch (const LedgerJson::parse_error& error) {
      const std::string_view before = text.substr(0, std::min(text.size(), error.byte));
      fail("line " + std::to_string(1 + std::ranges::count(before, '\n')), "not JSON");
    } catch (const LedgerJson::exception&) {
      fail("", "a number out of range");
    }
  }

  double number(const LedgerJson& object, const char* key, const std::string& place,
                double most) const {
    const auto value = object.find(key);
    if (value == object.end()) fail(place, "is missing");
    return number(*value, place, most);
  }
  double number(const LedgerJson& value, const std::string& place, double most) const {
    const double got = value.is_number() ? value.get<double>() : -1;
    if (!(got >= 0 && got <= most))
      fail(place, "is no number from 0 to " + LedgerJson(most).dump());
    return got;
  }

  std::vector<Event> read_rank(const LedgerJson& events) {
    const std::size_t rank = rank_++;
    if (!events.is_array()) fail("rank " + std::to_string(rank), "is no list of events");
    std::vector<Event> result;
    result.reserve(events.size());
    for (const LedgerJson& event : events) {
      place_ = place_of_event(rank, result.size());
      result.push_back(read_event(event));
      if (result.back().is_repeated && !is_repeat(result)) fail(place_, "repeats no send");
    }
    return result;
  }

  static bool is_repeat(const std::vector<Event>& events) {
    if (events.size() < 2) return false;
    const Event &last = events.back(), &before = events[events.size() - 2];
    return before.kind == Event::Kind::send && before.amount == last.amount &&
           before.tag == last.tag;
  }

  Event read_event(const LedgerJson& json) const {
    if (!json.is_array() || json.size() != kEventFields || !json[0].is_string() ||
        !json[1].is_string())
      fail(place_, "is no event of kind, phase and 6 numbers");
    Event event;
    read_kind(json[0].get<std::string>(), event);
    const std::string phase = json[1].get<std::string>();
    int index = 0;
    while (index < kPhases && phase != name(static_cast<Phase>(index))) ++index;
    if (index == kPhases) fail(place_, "has no phase that is known");
    event.phase = static_cast<Phase>(index);
    event.round = static_cast<std::int32_t>(whole(json[2], kMostRounds, "round"));
    const bool is_message = event.kind == Event::Kind::send || event.kind == Event::Kind::receive;
    if (is_message) {
      event.peer =
          static_cast<std::int32_t>(whole(json[3], static_cast<std::uint64_t>(count_ - 1), "peer"));
      event.tag = static_cast<Tag>(whole(json[4], 1U << 30U, "tag"));
    }
    event.amount = whole(json[5], std::uint64_t{1} << 62, "amount");
    event.begin = 1e-9 * number(json[6], place_ + ", begin", kMostNanoseconds);
    event.end = 1e-9 * number(json[7], place_ + ", end", kMostNanoseconds);
    if (event.end < event.begin) fail(place_, "ends before it begins");
    return event;
  }

  void read_kind(const std::string& kind, Event& event) const {
    if (kind == "send" || kind == "send on") {
      event.kind = Event::Kind::send;
      event.is_repeated = kind == "send on";
    } else if (kind == "receive") {
      event.kind = Event::Kind::receive;
    } else if (kind == "mark") {
      event.kind = Event::Kind::mark;
    } else {
      int unit = 0;
      while (unit < kWorkKinds && kind != name(static_cast<Work>(unit))) ++unit;
      if (unit == kWorkKinds) fail(place_, "is of no kind that is known");
      event.kind = Event::Kind::work;
      event.work = static_cast<Work>(unit);
    }
  }

  std::uint64_t whole(const LedgerJson& value, std::uint64_t most, const char* what) const {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > most)
      fail(place_, "has a " + std::string(what) + " that is no whole number from 0 to " +
                       std::to_string(most));
    return value.get<std::uint64_t>();
  }

  // More may be sent than is received, as a program may leave messages.
  void check_messages(const Ledger& ledger) const {
    std::vector<std::unordered_map<std::uint64_t, std::uint64_t>> sent(ledger.ranks.size());
    const auto key = [](std::size_t from, Tag tag) {
      return static_cast<std::uint64_t>(from) << 32 | static_cast<std::uint32_t>(tag);
    };
    for (std::size_t rank = 0; rank < ledger.ranks.size(); ++rank) {
      for (const Event& event : ledger.ranks[rank]) {
        if (event.kind == Event::Kind::send)
          ++sent[static_cast<std::size_t>(event.peer)][key(rank, event.tag)];
      }
    }
    for (std::size_t rank = 0; rank < ledger.ranks.size(); ++rank) {
      for (std::size_t i = 0; i < ledger.ranks[rank].size(); ++i) {
        const Event& event = ledger.ranks[rank][i];
        if (event.kind != Event::Kind::receive) continue;
        std::uint64_t& left = sent[rank][key(static_cast<std::size_t>(event.peer), event.tag)];
        if (left == 0) {
          fail(place_of_event(rank, i),
               "receives what rank " + std::to_string(event.peer) + " never sends");
        }
        --left;
      }
    }
  }

  const std::string& file_;
  std::string place_;
  std::size_t rank_ = 0;
  int count_ = 0;
};

constexpr std::uint64_t kLarge = 65536;  // bytes of messages that tell what a byte takes

// Lets all messages together take the processor's time that they took, where that was recorded.
void fit_processor_time(const Ledger& ledger, Network& network) {
  struct Sum {
    double seconds = 0, bytes = 0, messages = 0;
    void add(const Event& event) {
      seconds += event.processor;
      bytes += static_cast<double>(event.amount);
      messages += 1;
    }
  } all, large;
  for (std::size_t rank = 0; rank < ledger.ranks.size(); ++rank) {
    for (const Event& event : ledger.ranks[rank]) {
      const bool is_message = event.kind == Event::Kind::send || event.kind == Event::Kind::receive;
      if (!is_message || event.peer == static_cast<int>(rank)) continue;
      all.add(event);
      if (event.amount >= kLarge) large.add(event);
    }
  }
  if (!(all.seconds > 0)) return;
  const double for_byte = large.bytes > 0 ? large.seconds / large.bytes : 0;
  network.overhead = std::max(0.0, all.seconds - for_byte * all.bytes) / all.messages;
  network.copy_seconds_per_byte = for_byte;
}

double quartile_of(std::vector<double>& values) {
  if (values.empty()) return 0;
  const auto quartile = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 4);
  std::ranges::nth_element(values, quartile);
  return *quartile;
}

}  // namespace

std::string ledger_text(const RecordedRun& run) {
  const std::string program =
      LedgerJson(run.program).dump(-1, ' ', true, LedgerJson::error_handler_t::replace);
  std::string text =
      "{\"schema\": \"" + std::string(kLedgerSchema) + "\",\n\"program\": " + program +
      ",\n\"seconds\": " + LedgerJson(run.seconds).dump() +
      (run.other_programs < 0 ? std::string()
                              : ",\n\"other_programs\": " + LedgerJson(run.other_programs).dump()) +
      ",\n\"machine\": " + network_text(run.machine) +
      ",\n\"event\": [\"kind\", \"phase\", \"round\", \"peer\", \"tag\", \"amount\", "
      "\"begin\", \"end\"],\n\"ranks\": [";
  const char* before_rank = "\n[";
  for (const std::vector<Event>& events : run.ledger.ranks) {
    text += before_rank;
    before_rank = ",\n[";
    const char* before_event = "[\"";
    for (const Event& event : events) {
      (text += before_event).append(kind_name(event)).append("\",\"").append(name(event.phase)) +=
          '"';
      for (const std::int64_t number :
           {std::int64_t{event.round}, std::int64_t{event.peer}, std::int64_t{event.tag},
            static_cast<std::int64_t>(event.amount), nanoseconds(event.begin),
            nanoseconds(event.end)}) {
        (text += ',') += std::to_string(number);
      }
      text += ']';
      before_event = ",[\"";
    }
    text += ']';
  }
  return text + "\n]}\n";
}

RecordedRun parse_ledger(std::string_view text, const std::string& file) {
  return LedgerReader(file).read(text);
}

RecordedRun read_ledger(const std::string& file) {
  return parse_ledger(files::read_file(file), file);
}

NamedNetwork machine_of(const Ledger& ledger, int cores) {
  constexpr std::uint64_t kSmall = 4096;
  std::vector<double> small, large;
  for (std::size_t rank = 0; rank < ledger.ranks.size(); ++rank) {
    for (const Event& event : ledger.ranks[rank]) {
      if (event.kind != Event::Kind::send || event.is_repeated) continue;
      if (event.peer == static_cast<int>(rank)) continue;
      if (event.amount <= kSmall) small.push_back(event.end - event.begin);
      if (event.amount >= kLarge)
        large.push_back((event.end - event.begin) / static_cast<double>(event.amount));
    }
  }
  NamedNetwork machine{"this-machine", "The machine that the run was recorded on", {}, false};
  machine.network.latency = 0;
  machine.network.overhead = quartile_of(small);
  machine.network.seconds_per_byte = 1e-15;
  machine.network.copy_seconds_per_byte = quartile_of(large);
  fit_processor_time(ledger, machine.network);
  if (cores < static_cast<int>(ledger.ranks.size())) machine.network.shared_cores = cores;
  return machine;
}

}  // namespace delray::comm
