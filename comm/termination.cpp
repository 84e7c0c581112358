// Termination detection by four counters (Mattern 1987), along a binomial tree of ranks.
//
// The root starts a wave, ranks pass it down, and each idle rank returns the sums of its subtree
// once its children's have come. The end is found when the messages received by the end of one wave
// are as many as those sent by the end of the next. 2 (n - 1) messages per wave.
//
// Degenerate: a single rank needs two waves without messages, done in one call of idle() if no
// message of its own waits for it.
#include "comm/termination.h"

#include <utility>

namespace delray::comm {
namespace {

// Calls f(child) for each child of `rank` in the binomial tree over n ranks with root 0.
template <class F>
void for_each_child(int rank, int n, F&& f) {
  for (int step = 1; rank + step < n && (rank & step) == 0; step *= 2) f(rank + step);
}

int parent_of(int rank) { return rank & (rank - 1); }

}  // namespace

Termination::Termination(Communicator& communicator, Tag control)
    : communicator_(communicator), control_(control), children_(0) {
  for_each_child(communicator.rank(), communicator.size(), [&](int) { ++children_; });
}

void Termination::send_to_children(Control::Kind kind) {
  for_each_child(communicator_.rank(), communicator_.size(), [&](int child) {
    communicator_.send(child, control_, Buffer::of_value(Control{kind, 0, {}}));
  });
}

void Termination::handle(const Envelope& envelope) {
  const Buffer message = communicator_.receive(envelope.source, control_);
  const Control control = message.as<Control>()[0];
  switch (control.kind) {
    case Control::Kind::ask:
      in_wave_ = true;
      missing_ = children_;
      subtree_ = {};
      ++waves_;
      send_to_children(Control::Kind::ask);
      break;
    case Control::Kind::answer:
      subtree_.sent += control.counters.sent;
      subtree_.received += control.counters.received;
      --missing_;
      break;
    case Control::Kind::end:
      over_ = true;
      send_to_children(Control::Kind::end);
      break;
  }
}

void Termination::idle() {
  if (over_) return;
  const bool is_root = communicator_.rank() == 0;
  // A root on its own needs no messages for its waves. Two that do not agree mean that a message of
  // its own waits for it.
  for (int wave = 0; wave < 2; ++wave) {
    if (is_root && !in_wave_) {
      in_wave_ = true;
      missing_ = children_;
      subtree_ = {};
      ++waves_;
      send_to_children(Control::Kind::ask);
    }
    if (!in_wave_ || missing_ > 0) return;
    in_wave_ = false;
    const Counters sum{subtree_.sent + mine_.sent, subtree_.received + mine_.received};
    if (!is_root) {
      communicator_.send(parent_of(communicator_.rank()), control_,
                         Buffer::of_value(Control{Control::Kind::answer, 0, sum}));
      return;
    }
    // Counters only grow: when what was received by the end of one wave equals what was sent by the
    // end of the next, nothing was under way in between and nothing happened since.
    const bool over = has_last_ && last_.received == sum.sent;
    last_ = sum;
    has_last_ = true;
    if (over) {
      over_ = true;
      send_to_children(Control::Kind::end);
      return;
    }
  }
}

}  // namespace delray::comm
