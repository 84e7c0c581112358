// Sends are recorded when they return, receives when the program learns that they are complete:
// from then on it may use them. The order of a rank's events is that of these moments, so that a
// replay that repeats it cannot come to a deadlock.
//
// Requests of receives and persistent ones are remembered until then. A receive whose end a program
// never asks for (MPI_Request_free) is not recorded.
#include <unordered_map>
#include <vector>

#include "comm/mpi_record/journal.h"

namespace delray::comm::mpi_record {
namespace {

// A receive, or a persistent send.
struct Pending {
  MPI_Comm communicator = MPI_COMM_NULL;
  MPI_Datatype type = MPI_BYTE;
  int count = 0, peer = 0, tag = 0;
  bool is_send = false, is_persistent = false;
};

// What is under way; guarded by the journal's lock.
struct UnderWay {
  std::unordered_map<std::uintptr_t, Pending> requests;
  std::unordered_map<std::uintptr_t, MPI_Comm> probed;  // by message
};
UnderWay& under_way() {
  static UnderWay all;
  return all;
}

template <class Handle>
std::uintptr_t key_of(Handle handle) {
  return (std::uintptr_t)handle;
}

void remember(MPI_Request request, const Pending& one) {
  const std::lock_guard lock(journal().mutex());
  if (journal().is_running() && request != MPI_REQUEST_NULL)
    under_way().requests[key_of(request)] = one;
}

void note_received(const MPI_Status& status, const Pending& one, double begin) {
  int count = 0, cancelled = 0;
  PMPI_Test_cancelled(&status, &cancelled);
  if (cancelled != 0) return;
  PMPI_Get_count(&status, one.type, &count);
  const std::uint64_t bytes = bytes_of(count == MPI_UNDEFINED ? one.count : count, one.type);
  journal().receive(status.MPI_SOURCE, status.MPI_TAG, bytes, one.communicator, begin);
}

void received(const MPI_Status& status, const Pending& one, double begin) {
  const std::lock_guard lock(journal().mutex());
  if (journal().is_running()) note_received(status, one, begin);
}

// The request that stood there before the call is complete.
void completed(std::uintptr_t request, const MPI_Status& status, double begin) {
  const std::lock_guard lock(journal().mutex());
  const auto at = under_way().requests.find(request);
  if (!journal().is_running() || at == under_way().requests.end()) return;
  if (!at->second.is_send) note_received(status, at->second, begin);
  if (!at->second.is_persistent) under_way().requests.erase(at);
}

void started(MPI_Request request, double begin) {
  const std::lock_guard lock(journal().mutex());
  const auto at = under_way().requests.find(key_of(request));
  if (!journal().is_running() || at == under_way().requests.end() || !at->second.is_send) return;
  const Pending& one = at->second;
  journal().send(one.peer, one.tag, bytes_of(one.count, one.type), one.communicator, begin);
}

void sent(int count, MPI_Datatype type, int to, int tag, MPI_Comm all, double begin) {
  const std::lock_guard lock(journal().mutex());
  if (journal().is_running()) journal().send(to, tag, bytes_of(count, type), all, begin);
}

std::vector<std::uintptr_t> keys_of(const MPI_Request* requests, int count) {
  std::vector<std::uintptr_t> keys;
  for (int i = 0; i < count; ++i) keys.push_back(key_of(requests[i]));
  return keys;
}

void hand_over(const MPI_Status& own, MPI_Status* status) {
  if (status != MPI_STATUS_IGNORE) *status = own;
}
void hand_over(const std::vector<MPI_Status>& own, int count, MPI_Status* statuses) {
  for (int i = 0; i < count && statuses != MPI_STATUSES_IGNORE; ++i)
    statuses[i] = own[static_cast<std::size_t>(i)];
}

void probed(MPI_Message message, MPI_Comm all) {
  const std::lock_guard lock(journal().mutex());
  if (message != MPI_MESSAGE_NULL) under_way().probed[key_of(message)] = all;
}
MPI_Comm communicator_of(MPI_Message message) {
  const std::lock_guard lock(journal().mutex());
  const auto at = under_way().probed.find(key_of(message));
  if (at == under_way().probed.end()) return MPI_COMM_WORLD;
  const MPI_Comm all = at->second;
  under_way().probed.erase(at);
  return all;
}

}  // namespace
}  // namespace delray::comm::mpi_record

using namespace delray::comm::mpi_record;

// The names that a program calls; each does what MPI does, and notes it. Parameters are the
// standard's: data, count, type, peer, tag, communicator.
#define DELRAY_TO const void *data, int count, MPI_Datatype type, int peer, int tag, MPI_Comm all
#define DELRAY_FROM void *data, int count, MPI_Datatype type, int peer, int tag, MPI_Comm all
#define DELRAY_WITH data, count, type, peer, tag, all

#define DELRAY_SEND(NAME)                          \
  int NAME(DELRAY_TO) {                            \
    const Call call;                               \
    const int result = P##NAME(DELRAY_WITH);       \
    sent(count, type, peer, tag, all, call.begin); \
    return result;                                 \
  }
#define DELRAY_SEND_LATER(NAME)                       \
  int NAME(DELRAY_TO, MPI_Request* request) {         \
    const Call call;                                  \
    const int result = P##NAME(DELRAY_WITH, request); \
    sent(count, type, peer, tag, all, call.begin);    \
    return result;                                    \
  }
#define DELRAY_SEND_OFTEN(NAME)                                    \
  int NAME(DELRAY_TO, MPI_Request* request) {                      \
    const Call call;                                               \
    const int result = P##NAME(DELRAY_WITH, request);              \
    remember(*request, {all, type, count, peer, tag, true, true}); \
    return result;                                                 \
  }

extern "C" {

DELRAY_SEND(MPI_Send)
DELRAY_SEND(MPI_Ssend)
DELRAY_SEND(MPI_Bsend)
DELRAY_SEND(MPI_Rsend)
DELRAY_SEND_LATER(MPI_Isend)
DELRAY_SEND_LATER(MPI_Issend)
DELRAY_SEND_LATER(MPI_Ibsend)
DELRAY_SEND_LATER(MPI_Irsend)
DELRAY_SEND_OFTEN(MPI_Send_init)
DELRAY_SEND_OFTEN(MPI_Ssend_init)
DELRAY_SEND_OFTEN(MPI_Bsend_init)
DELRAY_SEND_OFTEN(MPI_Rsend_init)

int MPI_Recv(DELRAY_FROM, MPI_Status* status) {
  const Call call;
  MPI_Status own;
  const int result = PMPI_Recv(DELRAY_WITH, &own);
  received(own, {all, type, count}, call.begin);
  hand_over(own, status);
  return result;
}
int MPI_Irecv(DELRAY_FROM, MPI_Request* request) {
  const Call call;
  const int result = PMPI_Irecv(DELRAY_WITH, request);
  remember(*request, {all, type, count});
  return result;
}
int MPI_Recv_init(DELRAY_FROM, MPI_Request* request) {
  const Call call;
  const int result = PMPI_Recv_init(DELRAY_WITH, request);
  remember(*request, {all, type, count, peer, tag, false, true});
  return result;
}
int MPI_Start(MPI_Request* request) {
  const Call call;
  const int result = PMPI_Start(request);
  started(*request, call.begin);
  return result;
}
int MPI_Startall(int count, MPI_Request requests[]) {
  const Call call;
  const int result = PMPI_Startall(count, requests);
  for (int i = 0; i < count; ++i) started(requests[i], call.begin);
  return result;
}

int MPI_Mprobe(int from, int tag, MPI_Comm all, MPI_Message* message, MPI_Status* status) {
  const Call call;
  const int result = PMPI_Mprobe(from, tag, all, message, status);
  probed(*message, all);
  return result;
}
int MPI_Improbe(int from, int tag, MPI_Comm all, int* flag, MPI_Message* message,
                MPI_Status* status) {
  const Call call;
  const int result = PMPI_Improbe(from, tag, all, flag, message, status);
  if (*flag != 0) probed(*message, all);
  return result;
}
int MPI_Mrecv(void* data, int count, MPI_Datatype type, MPI_Message* message, MPI_Status* status) {
  const Call call;
  const MPI_Comm all = communicator_of(*message);
  MPI_Status own;
  const int result = PMPI_Mrecv(data, count, type, message, &own);
  received(own, {all, type, count}, call.begin);
  hand_over(own, status);
  return result;
}
int MPI_Imrecv(void* data, int count, MPI_Datatype type, MPI_Message* message,
               MPI_Request* request) {
  const Call call;
  const MPI_Comm all = communicator_of(*message);
  const int result = PMPI_Imrecv(data, count, type, message, request);
  remember(*request, {all, type, count});
  return result;
}

int MPI_Sendrecv(const void* data, int count, MPI_Datatype type, int to, int tag, void* into,
                 int into_count, MPI_Datatype into_type, int from, int from_tag, MPI_Comm all,
                 MPI_Status* status) {
  const Call call;
  MPI_Status own;
  const int result = PMPI_Sendrecv(data, count, type, to, tag, into, into_count, into_type, from,
                                   from_tag, all, &own);
  sent(count, type, to, tag, all, call.begin);
  received(own, {all, into_type, into_count}, call.begin);
  hand_over(own, status);
  return result;
}
int MPI_Sendrecv_replace(void* data, int count, MPI_Datatype type, int to, int tag, int from,
                         int from_tag, MPI_Comm all, MPI_Status* status) {
  const Call call;
  MPI_Status own;
  const int result = PMPI_Sendrecv_replace(data, count, type, to, tag, from, from_tag, all, &own);
  sent(count, type, to, tag, all, call.begin);
  received(own, {all, type, count}, call.begin);
  hand_over(own, status);
  return result;
}

int MPI_Wait(MPI_Request* request, MPI_Status* status) {
  const Call call;
  const std::uintptr_t key = key_of(*request);
  MPI_Status own;
  const int result = PMPI_Wait(request, &own);
  completed(key, own, call.begin);
  hand_over(own, status);
  return result;
}
int MPI_Test(MPI_Request* request, int* flag, MPI_Status* status) {
  const Call call;
  const std::uintptr_t key = key_of(*request);
  MPI_Status own;
  const int result = PMPI_Test(request, flag, &own);
  if (*flag == 0) return result;
  completed(key, own, call.begin);
  hand_over(own, status);
  return result;
}
int MPI_Waitall(int count, MPI_Request requests[], MPI_Status* statuses) {
  const Call call;
  const std::vector<std::uintptr_t> keys = keys_of(requests, count);
  std::vector<MPI_Status> own(keys.size());
  const int result = PMPI_Waitall(count, requests, own.data());
  for (std::size_t i = 0; i < keys.size(); ++i) completed(keys[i], own[i], call.begin);
  hand_over(own, count, statuses);
  return result;
}
int MPI_Testall(int count, MPI_Request requests[], int* flag, MPI_Status* statuses) {
  const Call call;
  const std::vector<std::uintptr_t> keys = keys_of(requests, count);
  std::vector<MPI_Status> own(keys.size());
  const int result = PMPI_Testall(count, requests, flag, own.data());
  if (*flag == 0) return result;
  for (std::size_t i = 0; i < keys.size(); ++i) completed(keys[i], own[i], call.begin);
  hand_over(own, count, statuses);
  return result;
}
int MPI_Waitany(int count, MPI_Request requests[], int* index, MPI_Status* status) {
  const Call call;
  const std::vector<std::uintptr_t> keys = keys_of(requests, count);
  MPI_Status own;
  const int result = PMPI_Waitany(count, requests, index, &own);
  if (*index != MPI_UNDEFINED) completed(keys[static_cast<std::size_t>(*index)], own, call.begin);
  hand_over(own, status);
  return result;
}
int MPI_Testany(int count, MPI_Request requests[], int* index, int* flag, MPI_Status* status) {
  const Call call;
  const std::vector<std::uintptr_t> keys = keys_of(requests, count);
  MPI_Status own;
  const int result = PMPI_Testany(count, requests, index, flag, &own);
  if (*flag == 0) return result;
  if (*index != MPI_UNDEFINED) completed(keys[static_cast<std::size_t>(*index)], own, call.begin);
  hand_over(own, status);
  return result;
}

#define DELRAY_SOME(NAME)                                                                        \
  int NAME(int count, MPI_Request requests[], int* done, int indices[], MPI_Status statuses[]) { \
    const Call call;                                                                             \
    const std::vector<std::uintptr_t> keys = keys_of(requests, count);                           \
    std::vector<MPI_Status> own(keys.size());                                                    \
    const int result = P##NAME(count, requests, done, indices, own.data());                      \
    if (*done == MPI_UNDEFINED) return result;                                                   \
    for (int i = 0; i < *done; ++i)                                                              \
      completed(keys[static_cast<std::size_t>(indices[i])], own[static_cast<std::size_t>(i)],    \
                call.begin);                                                                     \
    hand_over(own, *done, statuses);                                                             \
    return result;                                                                               \
  }
DELRAY_SOME(MPI_Waitsome)
DELRAY_SOME(MPI_Testsome)

int MPI_Request_free(MPI_Request* request) {
  const Call call;
  {
    const std::lock_guard lock(journal().mutex());
    under_way().requests.erase(key_of(*request));
  }
  return PMPI_Request_free(request);
}

}  // extern "C"
