// A communicator over a program's own functions.
//
// The table has no way to look at a message before it is received, so each is announced: 16 bytes
// with its tag and size, under the one tag that all of this has, as messages of one source stay in
// order. What comes before it is asked for waits in a queue. Sends are waited for when a phase
// begins and when it is asked for: others need nothing else of this rank then to take in what it
// has sent. In the midst of a phase ranks could wait for each other in a circle.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <deque>
#include <map>
#include <stdexcept>
#include <utility>

#include "comm/communicator.h"
#include "icet/communicators.h"
#include "icet/error.h"

namespace delray::icet {
namespace {

constexpr int kTag = 97;
constexpr std::size_t kPiece = std::size_t{1} << 30;  // counts of the table are of int

struct Announcement {
  std::int64_t tag = 0;
  std::uint64_t bytes = 0;
};

class ProgramCommunicator final : public comm::Communicator {
 public:
  explicit ProgramCommunicator(IceTCommunicator given) : table_(given->Duplicate(given)) {
    if (table_ == nullptr) throw Error(ICET_INVALID_VALUE, "a communicator cannot be duplicated");
    rank_ = table_->Comm_rank(table_);
    size_ = table_->Comm_size(table_);
  }
  ~ProgramCommunicator() override {
    ProgramCommunicator::finish_sends();
    table_->Destroy(table_);
  }

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int world_rank(int rank) const override { return rank; }
  double seconds() const override { return icetWallTime(); }

  void send(int to, comm::Tag tag, comm::Buffer&& message) override {
    if (to < 0 || to >= size_) throw std::invalid_argument("there is no such rank");
    if (to == rank_) {
      came_[to].push_back({tag, std::move(message)});
      return;
    }
    Sent& sent = sent_.emplace_back();
    sent.announcement = {tag, message.size()};
    sent.message = std::move(message);
    start(sent, &sent.announcement, sizeof sent.announcement, to);
    for (std::size_t at = 0; at < sent.message.size(); at += kPiece) {
      start(sent, sent.message.data() + at, std::min(kPiece, sent.message.size() - at), to);
    }
  }

  comm::Buffer receive(int from, comm::Tag tag) override {
    if (from < 0 || tag < 0) throw std::logic_error("a receive names its source and tag here");
    std::deque<Came>& came = came_[from];
    auto found =
        std::find_if(came.begin(), came.end(), [&](const Came& m) { return m.tag == tag; });
    if (found == came.end()) {
      if (from == rank_) throw std::logic_error("a rank waits for itself");
      do {
        came.push_back(next(from));
      } while (came.back().tag != tag);
      found = came.end() - 1;
    }
    comm::Buffer message = std::move(found->message);
    came.erase(found);
    return message;
  }

  std::optional<comm::Envelope> probe(int /*from*/, comm::Tag /*tag*/,
                                      comm::Deadline /*deadline*/) override {
    throw std::logic_error("a program's communicator cannot be probed");
  }
  std::unique_ptr<comm::Communicator> split(int /*color*/, int /*key*/) override {
    throw std::logic_error("a program's communicator is not split");
  }
  void mark(comm::Phase /*phase*/, int round) override {
    if (round == 0) finish_sends();
  }
  void finish_sends() override {
    for (Sent& sent : sent_) {
      for (IceTCommRequest& request : sent.requests) table_->Wait(table_, &request);
    }
    sent_.clear();
  }
  void work(comm::Work /*kind*/, std::uint64_t /*amount*/) override {}
  void abort(std::string why) override {
    raise_error(ICET_SANITY_CHECK_FAIL, why);
    std::abort();
  }

 private:
  struct Came {
    comm::Tag tag;
    comm::Buffer message;
  };
  struct Sent {
    Announcement announcement;
    comm::Buffer message;
    std::deque<IceTCommRequest> requests;
  };

  void start(Sent& sent, const void* bytes, std::size_t size, int to) {
    sent.requests.push_back(
        table_->Isend(table_, bytes, static_cast<int>(size), ICET_BYTE, to, kTag));
  }
  Came next(int from) {
    Announcement announcement;
    table_->Recv(table_, &announcement, sizeof announcement, ICET_BYTE, from, kTag);
    comm::Buffer message(announcement.bytes);
    for (std::size_t at = 0; at < message.size(); at += kPiece) {
      table_->Recv(table_, message.data() + at,
                   static_cast<int>(std::min(kPiece, message.size() - at)), ICET_BYTE, from, kTag);
    }
    return {static_cast<comm::Tag>(announcement.tag), std::move(message)};
  }

  IceTCommunicator table_;
  int rank_ = 0, size_ = 1;
  std::map<int, std::deque<Came>> came_;
  std::deque<Sent> sent_;  // stay where they are
};

}  // namespace

std::unique_ptr<comm::Communicator> make_program_communicator(IceTCommunicator given) {
  return std::make_unique<ProgramCommunicator>(given);
}

}  // namespace delray::icet
