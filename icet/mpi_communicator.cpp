// Communicators of the interface over MPI: the table of functions, each a call of MPI, for programs
// that use it themselves. Compositing goes past the table, over comm::make_mpi_communicator.
#include <memory>
#include <vector>

#include "comm/mpi.h"
#include "icet/communicators.h"
#include "icet/error.h"
#include "icet/mpi_interface.h"

namespace delray::icet {
namespace {

constexpr IceTEnum kRequest = 0xDE1A0001;

IceTCommunicator make_table(MPI_Comm own);

MPI_Comm comm_of(IceTCommunicator self) { return *static_cast<const MPI_Comm*>(self->data); }

MPI_Datatype type_of(IceTEnum type) {
  switch (type) {
    case ICET_BOOLEAN:
    case ICET_BYTE:
      return MPI_BYTE;
    case ICET_SHORT:
      return MPI_SHORT;
    case ICET_INT:
      return MPI_INT;
    case ICET_FLOAT:
      return MPI_FLOAT;
    case ICET_DOUBLE:
      return MPI_DOUBLE;
    default:
      raise_error(ICET_INVALID_ENUM, "a message is of no type that can be sent");
      return MPI_BYTE;
  }
}

IceTCommunicator duplicate(IceTCommunicator self) {
  MPI_Comm own = MPI_COMM_NULL;
  MPI_Comm_dup(comm_of(self), &own);
  return make_table(own);
}

// Of a program that has not used MPI this is false.
bool is_finalized() {
  int finalized = 0;
  MPI_Finalized(&finalized);
  return finalized != 0;
}

void destroy(IceTCommunicator self) {
  auto* const own = static_cast<MPI_Comm*>(self->data);
  if (!is_finalized()) MPI_Comm_free(own);
  delete own;
  delete self;
}

IceTCommunicator subset(IceTCommunicator self, int count, const std::int32_t* ranks) {
  MPI_Group all = MPI_GROUP_NULL, some = MPI_GROUP_NULL;
  MPI_Comm own = MPI_COMM_NULL;
  MPI_Comm_group(comm_of(self), &all);
  MPI_Group_incl(all, count, ranks, &some);
  MPI_Comm_create(comm_of(self), some, &own);
  MPI_Group_free(&some);
  MPI_Group_free(&all);
  return own == MPI_COMM_NULL ? nullptr : make_table(own);
}

void wait_for_all(IceTCommunicator self) { MPI_Barrier(comm_of(self)); }

void send(IceTCommunicator self, const void* buffer, int count, IceTEnum type, int to, int tag) {
  MPI_Send(buffer, count, type_of(type), to, tag, comm_of(self));
}

void receive(IceTCommunicator self, void* buffer, int count, IceTEnum type, int from, int tag) {
  MPI_Recv(buffer, count, type_of(type), from, tag, comm_of(self), MPI_STATUS_IGNORE);
}

void send_and_receive(IceTCommunicator self, const void* out, int out_count, IceTEnum out_type,
                      int to, int out_tag, void* in, int in_count, IceTEnum in_type, int from,
                      int in_tag) {
  MPI_Sendrecv(out, out_count, type_of(out_type), to, out_tag, in, in_count, type_of(in_type), from,
               in_tag, comm_of(self), MPI_STATUS_IGNORE);
}

void gather(IceTCommunicator self, const void* mine, int count, IceTEnum type, void* all,
            int root) {
  MPI_Gather(mine, count, type_of(type), all, count, type_of(type), root, comm_of(self));
}

void gather_sizes(IceTCommunicator self, const void* mine, int count, IceTEnum type, void* all,
                  const int* counts, const int* offsets, int root) {
  MPI_Gatherv(mine, count, type_of(type), all, counts, offsets, type_of(type), root, comm_of(self));
}

void gather_on_all(IceTCommunicator self, const void* mine, int count, IceTEnum type, void* all) {
  MPI_Allgather(mine, count, type_of(type), all, count, type_of(type), comm_of(self));
}

void all_to_all(IceTCommunicator self, const void* mine, int count, IceTEnum type, void* all) {
  MPI_Alltoall(mine, count, type_of(type), all, count, type_of(type), comm_of(self));
}

IceTCommRequest make_request(MPI_Request request) {
  return new IceTCommRequestStruct{kRequest, new MPI_Request(request)};
}

// Null for what is not one of ours.
MPI_Request* request_of(IceTCommRequest request) {
  return request != nullptr && request->magic_number == kRequest
             ? static_cast<MPI_Request*>(request->internals)
             : nullptr;
}

void forget(IceTCommRequest& request) {
  delete request_of(request);
  delete request;
  request = nullptr;
}

IceTCommRequest start_send(IceTCommunicator self, const void* buffer, int count, IceTEnum type,
                           int to, int tag) {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Isend(buffer, count, type_of(type), to, tag, comm_of(self), &request);
  return make_request(request);
}

IceTCommRequest start_receive(IceTCommunicator self, void* buffer, int count, IceTEnum type,
                              int from, int tag) {
  MPI_Request request = MPI_REQUEST_NULL;
  MPI_Irecv(buffer, count, type_of(type), from, tag, comm_of(self), &request);
  return make_request(request);
}

void wait(IceTCommunicator /*self*/, IceTCommRequest* request) {
  if (*request == nullptr) return;
  MPI_Request* const own = request_of(*request);
  if (own == nullptr)
    return raise_error(ICET_INVALID_VALUE, "a request is of another communicator");
  MPI_Wait(own, MPI_STATUS_IGNORE);
  forget(*request);
}

int wait_for_any(IceTCommunicator /*self*/, int count, IceTCommRequest* requests) {
  std::vector<MPI_Request> all(static_cast<std::size_t>(count), MPI_REQUEST_NULL);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (const MPI_Request* const own = request_of(requests[i])) all[i] = *own;
  }
  int done = MPI_UNDEFINED;
  MPI_Waitany(count, all.data(), &done, MPI_STATUS_IGNORE);
  if (done == MPI_UNDEFINED) return -1;
  forget(requests[done]);
  return done;
}

int size(IceTCommunicator self) {
  int result = 0;
  MPI_Comm_size(comm_of(self), &result);
  return result;
}

int rank(IceTCommunicator self) {
  int result = 0;
  MPI_Comm_rank(comm_of(self), &result);
  return result;
}

IceTCommunicator make_table(MPI_Comm own) {
  return new IceTCommunicatorStruct{
      duplicate,        destroy, subset,       wait_for_all,  send,       receive,
      send_and_receive, gather,  gather_sizes, gather_on_all, all_to_all, start_send,
      start_receive,    wait,    wait_for_any, size,          rank,       new MPI_Comm(own)};
}

}  // namespace

const void* mpi_of(IceTCommunicator given) {
  return given->Destroy == destroy ? given->data : nullptr;
}

std::unique_ptr<comm::Communicator> make_ranks(IceTCommunicator given) {
  if (given == nullptr) throw Error(ICET_INVALID_VALUE, "there is no communicator");
  if (const void* const own = mpi_of(given)) return comm::make_mpi_communicator(own);
  return make_program_communicator(given);
}

void end_ranks(std::unique_ptr<comm::Communicator> ranks) {
  if (is_finalized()) {
    [[maybe_unused]] auto* const leaked = ranks.release();
  }
}

}  // namespace delray::icet

extern "C" {

IceTCommunicator icetCreateMPICommunicator(MPI_Comm mpi_comm) {
  return delray::icet::guarded([&]() -> IceTCommunicator {
    if (mpi_comm == MPI_COMM_NULL) return nullptr;
    MPI_Comm own = MPI_COMM_NULL;
    MPI_Comm_dup(mpi_comm, &own);
    return delray::icet::make_table(own);
  });
}

void icetDestroyMPICommunicator(IceTCommunicator communicator) {
  if (communicator != nullptr) communicator->Destroy(communicator);
}

}  // extern "C"
