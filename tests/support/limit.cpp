// limit SECONDS COMMAND...: runs a command and ends it, with all that it has started, once it has
// had its time: not the wall clock's, which passes quickly for a test on a machine that others use
// as well.
//
// Its time is what passes while some of its threads run or none wants to. Time in which a thread
// waits for a core is the machine's (/proc/*/task/*/schedstat tells it). Processor time counts for
// itself, so that nobody spins for ever, and so does twenty times the wall clock's. Exit code: the
// command's, 124 where it was ended, 128 + signal where a signal ended it.
#include <dirent.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <map>
#include <string>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

// Of a thread, seconds.
struct Times {
  double ran = 0, waited = 0;
};

std::vector<std::string> entries(const std::string& folder) {
  std::vector<std::string> names;
  DIR* const listing = opendir(folder.c_str());
  if (listing == nullptr) return names;
  while (const dirent* entry = readdir(listing)) {
    if (entry->d_name[0] >= '0' && entry->d_name[0] <= '9') names.emplace_back(entry->d_name);
  }
  closedir(listing);
  return names;
}

int parent_of(const std::string& process) {
  std::ifstream file("/proc/" + process + "/stat");
  std::string line;
  std::getline(file, line);
  const std::size_t name_end = line.rfind(')');  // the name may have anything in it
  int parent = 0;
  char state = 0;
  if (name_end == std::string::npos ||
      std::sscanf(line.c_str() + name_end + 1, " %c %d", &state, &parent) != 2)
    return 0;
  return parent;
}

// This process's children, theirs and so on. Those whose parent has ended are its own.
std::vector<std::string> descendants() {
  std::map<int, std::vector<std::string>> children;
  for (const std::string& process : entries("/proc"))
    children[parent_of(process)].push_back(process);
  std::vector<std::string> found = children[getpid()];
  for (std::size_t i = 0; i < found.size(); ++i) {
    const std::vector<std::string> next = children[std::stoi(found[i])];
    found.insert(found.end(), next.begin(), next.end());
  }
  return found;
}

// Adds up over all threads that ever were.
class Account {
 public:
  void look() {
    for (const std::string& process : descendants()) {
      for (const std::string& thread : entries("/proc/" + process + "/task")) {
        std::ifstream file("/proc/" + process + "/task/" + thread + "/schedstat");
        Times times;
        if (!(file >> times.ran >> times.waited)) continue;
        Times& known = threads_[process + "/" + thread];
        sum_.ran += std::max(0.0, times.ran - known.ran) * 1e-9;
        sum_.waited += std::max(0.0, times.waited - known.waited) * 1e-9;
        known = times;
      }
    }
  }
  const Times& sum() const { return sum_; }

 private:
  std::map<std::string, Times> threads_;
  Times sum_;
};

void end_all() {
  // Whoever starts more meanwhile is found the next time.
  for (int i = 0; i < 100; ++i) {
    const std::vector<std::string> left = descendants();
    if (left.empty()) return;
    for (const std::string& process : left) kill(std::stoi(process), SIGKILL);
    while (waitpid(-1, nullptr, WNOHANG) > 0) {
    }
    usleep(20000);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const double limit = argc > 2 ? std::atof(argv[1]) : 0;
  if (!(limit > 0)) {
    std::fprintf(stderr, "limit SECONDS COMMAND...\n");
    return 2;
  }
  prctl(PR_SET_CHILD_SUBREAPER, 1);
  sigset_t ended_child, before;
  sigemptyset(&ended_child);
  sigaddset(&ended_child, SIGCHLD);
  sigprocmask(SIG_BLOCK, &ended_child, &before);
  const pid_t command = fork();
  if (command < 0) return 126;
  if (command == 0) {
    sigprocmask(SIG_SETMASK, &before, nullptr);
    execvp(argv[2], argv + 2);
    std::perror(argv[2]);
    _exit(127);
  }
  constexpr double kMostCores = 2, kMostWall = 20;
  constexpr timespec kBetween{0, 500'000'000};
  const Clock::time_point begin = Clock::now();
  Account account;
  double wall_last = 0, waited_last = 0, own = 0;
  for (;;) {
    int status = 0;
    for (pid_t ended = waitpid(-1, &status, WNOHANG); ended > 0;
         ended = waitpid(-1, &status, WNOHANG)) {
      if (ended != command) continue;
      return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    }
    if (sigtimedwait(&ended_child, nullptr, &kBetween) > 0) continue;
    account.look();
    const double wall = std::chrono::duration<double>(Clock::now() - begin).count();
    const Times& sum = account.sum();
    own += std::max(0.0, wall - wall_last - (sum.waited - waited_last));
    wall_last = wall;
    waited_last = sum.waited;
    if (own < limit && sum.ran < kMostCores * limit && wall < kMostWall * limit) continue;
    std::fprintf(stderr,
                 "limit: ended after %.0f s of its own time of %.0f s; processor %.0f s, waiting "
                 "for a core %.0f s, wall clock %.0f s\n",
                 own, limit, sum.ran, sum.waited, wall);
    end_all();
    return 124;
  }
}
