// A communicator that a program makes itself: one of MPI behind functions of its own.
#pragma once

#include "icet/mpi_interface.h"

namespace own {

// Sends that were started and not waited for.
inline int& unfinished() {
  static int count = 0;
  return count;
}

inline IceTCommunicator wrap(IceTCommunicator inner);
inline IceTCommunicator inner_of(IceTCommunicator self) {
  return static_cast<IceTCommunicator>(self->data);
}
inline IceTCommunicator duplicate(IceTCommunicator self) {
  return wrap(inner_of(self)->Duplicate(inner_of(self)));
}
inline void destroy(IceTCommunicator self) {
  inner_of(self)->Destroy(inner_of(self));
  delete self;
}
inline void receive(IceTCommunicator self, void* buffer, int count, IceTEnum type, int from,
                    int tag) {
  inner_of(self)->Recv(inner_of(self), buffer, count, type, from, tag);
}
inline IceTCommRequest start_send(IceTCommunicator self, const void* buffer, int count,
                                  IceTEnum type, int to, int tag) {
  ++unfinished();
  return inner_of(self)->Isend(inner_of(self), buffer, count, type, to, tag);
}
inline void wait(IceTCommunicator self, IceTCommRequest* request) {
  --unfinished();
  inner_of(self)->Wait(inner_of(self), request);
}
inline int size(IceTCommunicator self) { return inner_of(self)->Comm_size(inner_of(self)); }
inline int rank(IceTCommunicator self) { return inner_of(self)->Comm_rank(inner_of(self)); }

inline IceTCommunicator wrap(IceTCommunicator inner) {
  auto* const made = new IceTCommunicatorStruct();
  made->Duplicate = &duplicate;
  made->Destroy = &destroy;
  made->Recv = &receive;
  made->Isend = &start_send;
  made->Wait = &wait;
  made->Comm_size = &size;
  made->Comm_rank = &rank;
  made->data = inner;
  return made;
}

}  // namespace own
