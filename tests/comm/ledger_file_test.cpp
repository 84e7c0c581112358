#include "comm/ledger_file.h"

#include <gtest/gtest.h>

#include "comm/charged.h"
#include "comm/collectives.h"
#include "comm/recording.h"
#include "comm/replay.h"
#include "comm/simulated.h"
#include "comm/threads.h"
#include "files/error.h"

namespace delray::comm {
namespace {

// Three ranks that work, send to each other and add up.
RecordedRun small_run() {
  RecordedRun run;
  run.program = "a \"program\" \xff";
  run.seconds = 0.25;
  run.ledger.ranks.resize(3);
  Network network;
  network.seconds_per_work[0] = 1e-9;
  run_simulated(3, network, 1, [&](Communicator& c) {
    Recording recording(c, run.ledger.ranks[static_cast<std::size_t>(c.rank())]);
    recording.mark(Phase::compose, 2);
    recording.work(Work::seconds_e9, 1'000'000);
    recording.multicast(std::vector{0, 1, 2}, 3, Buffer(100));
    for (int from = 0; from < 3; ++from) recording.receive(from, 3);
    recording.work(Work::rays, 7);
    barrier(recording);
  });
  run.machine = machine_of(run.ledger, 2);
  return run;
}

TEST(LedgerFile, ReadsBackWhatWasWritten) {
  const RecordedRun run = small_run();
  const std::string text = ledger_text(run);
  const RecordedRun read = parse_ledger(text, "l.json");
  EXPECT_EQ(read.seconds, run.seconds);
  EXPECT_EQ(read.machine.network.shared_cores, 2);
  ASSERT_EQ(read.ledger.ranks.size(), 3U);
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_EQ(read.ledger.ranks[k].size(), run.ledger.ranks[k].size());
    for (std::size_t i = 0; i < read.ledger.ranks[k].size(); ++i) {
      const Event &a = run.ledger.ranks[k][i], &b = read.ledger.ranks[k][i];
      EXPECT_EQ(a.kind, b.kind);
      EXPECT_EQ(a.phase, b.phase);
      EXPECT_EQ(a.work, b.work);
      EXPECT_EQ(a.is_repeated, b.is_repeated);
      EXPECT_EQ(a.round, b.round);
      EXPECT_EQ(a.peer, b.peer);
      EXPECT_EQ(a.tag, b.tag);
      EXPECT_EQ(a.amount, b.amount);
      EXPECT_NEAR(a.begin, b.begin, 1e-9);
      EXPECT_NEAR(a.end, b.end, 1e-9);
    }
  }
  EXPECT_EQ(ledger_text(read).substr(text.find("\"ranks\"")), text.substr(text.find("\"ranks\"")));
  for (const NamedNetwork& named : networks())
    EXPECT_EQ(replay(read.ledger, named.network), replay(run.ledger, named.network)) << named.name;
}

TEST(LedgerFile, TheMachineIsWhatSendsTook) {
  Ledger ledger;
  ledger.ranks.resize(2);
  const auto send = [&](std::uint64_t bytes, double seconds) {
    Event event;
    event.kind = Event::Kind::send;
    event.peer = 1;
    event.amount = bytes;
    event.end = seconds;
    ledger.ranks[0].push_back(event);
  };
  for (const double microseconds : {5.0, 6.0, 900.0}) send(100, microseconds * 1e-6);
  for (const double microseconds : {20.0, 30.0, 700.0}) send(100'000, microseconds * 1e-6);
  const Network machine = machine_of(ledger, 4).network;
  EXPECT_DOUBLE_EQ(machine.overhead, 5e-6);
  EXPECT_DOUBLE_EQ(machine.copy_seconds_per_byte, 20e-11);
  EXPECT_EQ(machine.shared_cores, 0);
  EXPECT_EQ(machine_of(ledger, 1).network.shared_cores, 1);
  EXPECT_EQ(machine_of(Ledger{{{}, {}}}, 2).network.overhead, 0);
}

// All messages together take the processor what they took, large ones by their bytes.
TEST(LedgerFile, TheMachineTakesTheProcessorTimeOfAllMessages) {
  Ledger ledger;
  ledger.ranks.resize(2);
  double all = 0;
  const auto add = [&](Event::Kind kind, std::uint64_t bytes, double processor) {
    Event event;
    event.kind = kind;
    event.peer = 1;
    event.amount = bytes;
    event.end = 1;  // of the clock, most of it waiting
    event.processor = processor;
    all += processor;
    ledger.ranks[0].push_back(event);
  };
  add(Event::Kind::send, 100, 3e-6);
  add(Event::Kind::receive, 100, 9e-6);
  add(Event::Kind::send, 100'000, 20e-6);
  add(Event::Kind::receive, 300'000, 60e-6);
  const Network machine = machine_of(ledger, 1).network;
  EXPECT_NEAR(machine.copy_seconds_per_byte, 80e-6 / 400'000, 1e-15);
  double predicted = 0;
  for (const Event& event : ledger.ranks[0])
    predicted +=
        machine.overhead + machine.copy_seconds_per_byte * static_cast<double>(event.amount);
  EXPECT_NEAR(predicted, all, 0.05 * all);
}

// What waits for a device leaves its core to the others, in a replay as in the run.
TEST(LedgerFile, BlockedRanksLeaveTheirCores) {
  Ledger ledger;
  ledger.ranks.resize(3);
  const auto work = [&](std::size_t rank, Work kind) {
    Event event;
    event.kind = Event::Kind::work;
    event.work = kind;
    event.amount = 40'000'000;
    ledger.ranks[rank].push_back(event);
  };
  Network one_core;
  one_core.shared_cores = 1;
  work(0, Work::blocked_e9);
  work(1, Work::blocked_e9);
  work(2, Work::seconds_e9);
  for (const double end : replay(ledger, one_core)) EXPECT_NEAR(end, 0.04, 1e-9);
  // Ranks that compete take turns: all are done at about the same time.
  ledger.ranks.assign(3, {});
  for (std::size_t rank = 0; rank < 3; ++rank) work(rank, Work::seconds_e9);
  for (const double end : replay(ledger, one_core)) {
    EXPECT_GT(end, 0.11);
    EXPECT_LT(end, 0.12 + 1e-9);
  }
}

TEST(LedgerFile, OtherProgramsAreTold) {
  RecordedRun run = small_run();
  EXPECT_LT(parse_ledger(ledger_text(run), "l.json").other_programs, 0);
  run.other_programs = 1.5;
  EXPECT_EQ(parse_ledger(ledger_text(run), "l.json").other_programs, 1.5);
}

TEST(LedgerFile, RealRanksAreChargedForWhatTheyDoBetweenMessages) {
  for (const ChargedTime time : {ChargedTime::processor, ChargedTime::clock}) {
    std::vector<std::vector<Event>> events(2);
    run_threads(2, 1, [&](Communicator& c) {
      Recording recording(c, events[static_cast<std::size_t>(c.rank())]);
      Charged charged(recording, time);
      charged.work(Work::rays, 1000);  // in the time that passes
      double sum = 0;
      for (int i = 1; i < 100'000; ++i) sum += 1.0 / i;
      charged.send(1 - c.rank(), 1, Buffer::of_value(sum));
      charged.receive(1 - c.rank(), 1);
    });
    for (std::size_t k = 0; k < 2; ++k) {
      const Totals sum = totals(events[k], static_cast<int>(k));
      EXPECT_GT(sum.work[static_cast<std::size_t>(Work::seconds_e9)], 0U);
      EXPECT_EQ(sum.work[static_cast<std::size_t>(Work::rays)], 0U);
      EXPECT_EQ(sum.bytes_sent, sizeof(double));
    }
  }
}

TEST(LedgerFile, ErrorsNameFileAndPlace) {
  const auto with = [](const std::string& ranks) {
    return R"({"schema": "delray.ledger/1", "seconds": 1, "machine": {"schema": "delray.network/1",
        "topology": "crossbar", "latency": 0, "overhead": 0, "bytes_per_second": 1},
        "ranks": )" +
           ranks + "}";
  };
  const std::string send = R"(["send","other",0,1,5,8,0,1])";
  EXPECT_EQ(parse_ledger(with("[[" + send + R"(],[["receive","other",0,0,5,8,0,1]]])"), "l.json")
                .ledger.ranks.size(),
            2U);
  const struct {
    std::string text, place;
  } cases[] = {
      {"{\n", "line 2"},
      {"3", ""},
      {"{}", "\"schema\""},
      {R"({"schema": "delray.ledger/1"})", "\"seconds\""},
      {R"({"schema": "delray.ledger/1", "seconds": 1})", "\"machine\""},
      {with("[]"), "\"ranks\""},
      {with("[3]"), "rank 0"},
      {with("[[], [3]]"), "rank 1, event 0"},
      {with(R"([[["send","other",0,1,5,8,0]], []])"), "rank 0, event 0"},
      {with(R"([[["sand","other",0,1,5,8,0,1]], []])"), "rank 0, event 0"},
      {with(R"([[["send","outer",0,1,5,8,0,1]], []])"), "rank 0, event 0"},
      {with(R"([[["send","other",0,2,5,8,0,1]], []])"), "rank 0, event 0"},
      {with(R"([[["send","other",0,1,-5,8,0,1]], []])"), "rank 0, event 0"},
      {with(R"([[["send","other",0,1,5,1e30,0,1]], []])"), "rank 0, event 0"},
      {with(R"([[["send","other",0,1,5,8,2,1]], []])"), "rank 0, event 0"},
      {with(R"([[["send on","other",0,1,5,8,0,1]], []])"), "rank 0, event 0"},
      {with(R"([[["receive","other",0,1,5,8,0,1]], []])"), "rank 0, event 0"},
      {with("[[" + send + R"(], [["receive","other",0,0,6,8,0,1]]])"), "rank 1, event 0"},
  };
  for (const auto& one : cases) {
    try {
      parse_ledger(one.text, "l.json");
      ADD_FAILURE() << one.text;
    } catch (const files::FileError& error) {
      EXPECT_EQ(error.cause(), files::Cause::input);
      EXPECT_EQ(error.file(), "l.json");
      EXPECT_EQ(error.place(), one.place) << one.text << '\n' << error.what();
    }
  }
}

}  // namespace
}  // namespace delray::comm
