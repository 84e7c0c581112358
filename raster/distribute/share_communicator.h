// Stands for a communicator where a rank draws its share on its own.
#pragma once

#include <cstdlib>
#include <memory>
#include <optional>
#include <string>

#include "comm/communicator.h"

namespace delray::raster {

// Knows its rank and how many there would be; nobody is there to talk to.
class ShareCommunicator final : public comm::Communicator {
 public:
  ShareCommunicator(int rank, int size) : rank_(rank), size_(size) {}

  int rank() const override { return rank_; }
  int size() const override { return size_; }
  int world_rank(int rank) const override { return rank; }
  double seconds() const override { return 0; }
  void send(int, comm::Tag, comm::Buffer&&) override { std::abort(); }
  comm::Buffer receive(int, comm::Tag) override { std::abort(); }
  std::optional<comm::Envelope> probe(int, comm::Tag, comm::Deadline) override { std::abort(); }
  std::unique_ptr<comm::Communicator> split(int, int) override { std::abort(); }
  void mark(comm::Phase, int) override {}
  void work(comm::Work, std::uint64_t) override {}
  [[noreturn]] void abort(std::string) override { std::abort(); }

 private:
  int rank_, size_;
};

}  // namespace delray::raster
