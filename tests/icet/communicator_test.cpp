// The functions of a communicator of the interface of IceT over MPI, which programs may call
// themselves.
#include <numeric>
#include <vector>

#include "icet/mpi_interface.h"
#include "tests/icet/check.h"
#include "tests/icet/ranks.h"

namespace {

void test_table(IceTCommunicator c) {
  const Ranks all = ranks();
  const IceTInt next = (all.rank + 1) % all.size, before = (all.rank + all.size - 1) % all.size;
  IceTInt got = -1;
  c->Sendrecv(c, &all.rank, 1, ICET_INT, next, 3, &got, 1, ICET_INT, before, 3);
  CHECK(got == before);
  IceTCommRequest requests[2] = {c->Irecv(c, &got, 1, ICET_INT, before, 4),
                                 c->Isend(c, &next, 1, ICET_INT, next, 4)};
  const int first = c->Waitany(c, 2, requests);
  CHECK(first == 0 || first == 1);
  c->Wait(c, &requests[1 - first]);
  CHECK(got == all.rank && requests[0] == nullptr && requests[1] == nullptr);
  std::vector<IceTShort> mine(static_cast<std::size_t>(all.size), static_cast<IceTShort>(all.rank));
  std::vector<IceTShort> everybody(mine.size());
  c->Allgather(c, mine.data(), 1, ICET_SHORT, everybody.data());
  for (std::size_t i = 0; i < everybody.size(); ++i) CHECK(everybody[i] == static_cast<int>(i));
  c->Alltoall(c, everybody.data(), 1, ICET_SHORT, mine.data());
  for (const IceTShort value : mine) CHECK(value == all.rank);
  double value = all.rank + 0.5;
  std::vector<double> values(everybody.size());
  c->Gather(c, &value, 1, ICET_DOUBLE, values.data(), 0);
  if (all.rank == 0) CHECK(values.back() == all.size - 0.5);
  std::vector<int> counts(values.size(), 1), offsets(values.size());
  std::iota(offsets.begin(), offsets.end(), 0);
  c->Gatherv(c, &value, 1, ICET_DOUBLE, values.data(), counts.data(), offsets.data(), all.size - 1);
  if (all.rank == all.size - 1) CHECK(values.front() == 0.5);
  c->Barrier(c);
  const IceTInt last = all.size - 1;
  const IceTCommunicator alone = c->Subset(c, 1, &last);
  CHECK((alone != nullptr) == (all.rank == last));
  if (alone != nullptr) {
    CHECK(alone->Comm_size(alone) == 1);
    alone->Destroy(alone);
  }
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  const IceTCommunicator over_mpi = icetCreateMPICommunicator(MPI_COMM_WORLD);
  test_table(over_mpi);
  icetDestroyMPICommunicator(over_mpi);
  MPI_Finalize();
  return 0;
}
