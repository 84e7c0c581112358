// A program of MPI that knows nothing of Delray, for libdelray_record.so: it sends in each way that
// MPI has, and does each collective once. Ends with 1 where MPI did not do what it says.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <array>
#include <numeric>
#include <vector>

namespace {

int rank = 0, ranks = 1;
bool is_right = true;

int next() { return (rank + 1) % ranks; }
int before() { return (rank + ranks - 1) % ranks; }
void expect(bool fact) { is_right = is_right && fact; }

// Four bytes to the next rank, eight times.
void pass_on() {
  int mine = rank, got = -1;
  MPI_Request requests[2];
  MPI_Irecv(&got, 1, MPI_INT, before(), 7, MPI_COMM_WORLD, &requests[0]);
  MPI_Isend(&mine, 1, MPI_INT, next(), 7, MPI_COMM_WORLD, &requests[1]);
  MPI_Waitall(2, requests, MPI_STATUSES_IGNORE);
  expect(got == before());
  MPI_Sendrecv(&mine, 1, MPI_INT, next(), 8, &got, 1, MPI_INT, MPI_ANY_SOURCE, MPI_ANY_TAG,
               MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  expect(got == before());
  // Persistent ones, twice, and asked for until they are complete.
  MPI_Send_init(&mine, 1, MPI_INT, next(), 1 << 20, MPI_COMM_WORLD, &requests[0]);
  MPI_Recv_init(&got, 1, MPI_INT, before(), 1 << 20, MPI_COMM_WORLD, &requests[1]);
  for (int i = 0; i < 2; ++i) {
    MPI_Startall(2, requests);
    int done = 0;
    while (done == 0) MPI_Test(&requests[1], &done, MPI_STATUS_IGNORE);
    MPI_Wait(&requests[0], MPI_STATUS_IGNORE);
  }
  MPI_Request_free(&requests[0]);
  MPI_Request_free(&requests[1]);
  // By matched probes; nothing goes to or comes from nobody.
  MPI_Isend(&mine, 1, MPI_INT, next(), 9, MPI_COMM_WORLD, &requests[0]);
  MPI_Message message = MPI_MESSAGE_NULL;
  MPI_Mprobe(before(), 9, MPI_COMM_WORLD, &message, MPI_STATUS_IGNORE);
  MPI_Mrecv(&got, 1, MPI_INT, &message, MPI_STATUS_IGNORE);
  MPI_Wait(&requests[0], MPI_STATUS_IGNORE);
  MPI_Send(&mine, 1, MPI_INT, MPI_PROC_NULL, 9, MPI_COMM_WORLD);
  MPI_Recv(&got, 1, MPI_INT, MPI_PROC_NULL, 9, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  // In a communicator where ranks have other numbers.
  MPI_Comm reversed = MPI_COMM_NULL;
  MPI_Comm_split(MPI_COMM_WORLD, 0, -rank, &reversed);
  int number = 0;
  MPI_Comm_rank(reversed, &number);
  MPI_Isend(&mine, 1, MPI_INT, (number + 1) % ranks, 9, reversed, &requests[0]);
  int index = 0;
  MPI_Irecv(&got, 1, MPI_INT, (number + ranks - 1) % ranks, 9, reversed, &requests[1]);
  MPI_Waitany(1, &requests[1], &index, MPI_STATUS_IGNORE);
  MPI_Waitany(1, &requests[0], &index, MPI_STATUS_IGNORE);
  expect(got == next());
  MPI_Comm_free(&reversed);
}

void together() {
  const auto n = static_cast<std::size_t>(ranks);
  std::vector<int> mine(n, rank), all(n), counts(n, 1), starts(n);
  std::iota(starts.begin(), starts.end(), 0);
  MPI_Barrier(MPI_COMM_WORLD);
  MPI_Bcast(mine.data(), ranks, MPI_INT, 1 % ranks, MPI_COMM_WORLD);
  expect(mine[0] == 1 % ranks);
  int sum = 0;
  MPI_Reduce(&rank, &sum, 1, MPI_INT, MPI_SUM, ranks - 1, MPI_COMM_WORLD);
  MPI_Allreduce(&rank, &sum, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  expect(sum == ranks * (ranks - 1) / 2);
  MPI_Gather(&rank, 1, MPI_INT, all.data(), 1, MPI_INT, 0, MPI_COMM_WORLD);
  MPI_Gatherv(&rank, 1, MPI_INT, all.data(), counts.data(), starts.data(), MPI_INT, 0,
              MPI_COMM_WORLD);
  MPI_Scatter(all.data(), 1, MPI_INT, &sum, 1, MPI_INT, 0, MPI_COMM_WORLD);
  expect(sum == rank);
  MPI_Scatterv(all.data(), counts.data(), starts.data(), MPI_INT, &sum, 1, MPI_INT, 0,
               MPI_COMM_WORLD);
  MPI_Allgather(&rank, 1, MPI_INT, all.data(), 1, MPI_INT, MPI_COMM_WORLD);
  MPI_Allgatherv(&rank, 1, MPI_INT, all.data(), counts.data(), starts.data(), MPI_INT,
                 MPI_COMM_WORLD);
  MPI_Alltoall(mine.data(), 1, MPI_INT, all.data(), 1, MPI_INT, MPI_COMM_WORLD);
  MPI_Alltoallv(mine.data(), counts.data(), starts.data(), MPI_INT, all.data(), counts.data(),
                starts.data(), MPI_INT, MPI_COMM_WORLD);
  MPI_Reduce_scatter(mine.data(), &sum, counts.data(), MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  MPI_Reduce_scatter_block(mine.data(), &sum, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  MPI_Scan(&rank, &sum, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
  expect(sum == rank * (rank + 1) / 2);
  MPI_Exscan(&rank, &sum, 1, MPI_INT, MPI_SUM, MPI_COMM_WORLD);
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  pass_on();
  together();
  MPI_Finalize();
  return is_right ? 0 : 1;
}
