// How programs end when one of their MPI processes fails: by what the launcher prints and returns.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace {

struct Outcome {
  int exit_code = -1;
  std::string output;
};

// Runs comm_failing_rank with 4 processes. What has not ended after a minute of its own time
// (support/limit.cpp) hangs, and is ended with exit code 124; how long the launcher itself takes
// depends on the machine (look-ups of host names).
Outcome launch(const std::string& arguments) {
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  setenv("OMPI_MCA_rmaps_base_oversubscribe", "1", 1);
  setenv("OMPI_MCA_btl_vader_single_copy_mechanism", "none", 1);
  setenv("ASAN_OPTIONS", "detect_leaks=0", 1);  // of builds with it: Open MPI's own
  std::string command(DELRAY_LIMIT " 60 " DELRAY_MPIEXEC " -n 4 " DELRAY_FAILING_RANK " ");
  command += arguments;
  command += " 2>&1 < /dev/null";
  Outcome outcome;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return outcome;
  std::array<char, 4096> chunk;
  while (const std::size_t n = fread(chunk.data(), 1, chunk.size(), pipe)) {
    outcome.output.append(chunk.data(), n);
  }
  const int status = pclose(pipe);
  outcome.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

TEST(MpiFailure, ExceptionEndsAllWithFiveAndNamesTheRank) {
  const Outcome outcome = launch("throw 2");
  EXPECT_EQ(outcome.exit_code, 5) << outcome.output;
  EXPECT_NE(outcome.output.find("error: rank 2 failed in phase compose: the disk is on fire"),
            std::string::npos)
      << outcome.output;
}

TEST(MpiFailure, AbortIsAFailure) {
  const Outcome outcome = launch("abort 3");
  EXPECT_EQ(outcome.exit_code, 5) << outcome.output;
  EXPECT_NE(outcome.output.find("error: rank 3 failed in phase compose: nothing left to do"),
            std::string::npos)
      << outcome.output;
}

TEST(MpiFailure, BadInputOfOneRankEndsAllWithThree) {
  const Outcome outcome = launch("file 1");
  EXPECT_EQ(outcome.exit_code, 3) << outcome.output;
  EXPECT_NE(outcome.output.find("broken.ply: line 7: not a number"), std::string::npos)
      << outcome.output;
}

TEST(MpiFailure, AgreedBadInputIsThrownOnAllRanks) {
  const Outcome outcome = launch("agreed 1");
  EXPECT_EQ(outcome.exit_code, 3) << outcome.output;
  EXPECT_NE(outcome.output.find("all agree: broken.ply: line 7: not a number"), std::string::npos)
      << outcome.output;
  EXPECT_EQ(outcome.output.find("failed in phase"), std::string::npos) << outcome.output;
}

TEST(MpiFailure, StallEndsAllWithFive) {
  const Outcome outcome = launch("stall 0");
  EXPECT_EQ(outcome.exit_code, 5) << outcome.output;
  EXPECT_NE(outcome.output.find("for a message from rank 0 with tag 2"), std::string::npos)
      << outcome.output;
}

// It neither ends nor goes on. The line names it, whoever has waited for whom.
TEST(MpiFailure, AStoppedProcessIsNamedWithItsPhase) {
  const Outcome outcome = launch("stop 2");
  EXPECT_EQ(outcome.exit_code, 5) << outcome.output;
  EXPECT_NE(outcome.output.find("error: rank 2 failed in phase compose: stalled: rank"),
            std::string::npos)
      << outcome.output;
}

TEST(MpiFailure, OutOfMemoryIsNoLostRank) {
  const Outcome outcome = launch("memory 1");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.output;
  EXPECT_NE(outcome.output.find("error: rank 1 failed in phase compose: out of memory"),
            std::string::npos)
      << outcome.output;
}

TEST(MpiFailure, ArgumentsThatCannotBeAreWrongUsage) {
  const Outcome outcome = launch("argument 1");
  EXPECT_EQ(outcome.exit_code, 2) << outcome.output;
}

// One rank has too little address space to share memory from the beginning, or for that of another
// later on.
TEST(MpiFailure, WhereAddressSpaceIsShortMessagesGoAnotherWay) {
#ifdef DELRAY_ASAN
  GTEST_SKIP() << "the sanitizer takes address space without end";
#endif
  for (const std::string how : {"little", "less"}) {
    for (const std::string rank : {" 0", " 2"}) {
      const Outcome outcome = launch(how + rank);
      EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
    }
  }
}

// Processes that have this argument. A shell that has it among others in one argument is none.
std::vector<std::string> processes_with(const std::string& argument) {
  std::string wanted(1, '\0');
  wanted += argument;
  wanted += '\0';
  std::vector<std::string> found;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "cmdline", std::ios::binary);
    const std::string line((std::istreambuf_iterator<char>(file)), {});
    if (line.find(wanted) != std::string::npos) found.push_back(entry.path());
  }
  return found;
}

// Nothing can be done about SIGKILL: the launcher notices, and the others tell where they were.
TEST(MpiFailure, AfterAKilledProcessNothingIsLeftAndTheLogNamesThePhase) {
  std::string mark("mark-"), arguments("kill 1 ");
  mark += std::to_string(getpid());
  arguments += mark;
  const Outcome outcome = launch(arguments);
  EXPECT_EQ(outcome.exit_code, 137) << outcome.output;
  EXPECT_NE(outcome.output.find("was told to end in phase compose"), std::string::npos)
      << outcome.output;
  EXPECT_NE(outcome.output.find("signal 9"), std::string::npos) << outcome.output;
  EXPECT_EQ(processes_with(mark), std::vector<std::string>());
}

TEST(MpiFailure, MessagesThatNobodyReceivesDoNotHinderTheEnd) {
  const Outcome outcome = launch("none");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
}

}  // namespace
