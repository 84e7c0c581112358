// Behind DelrayCommunicator.
#pragma once

#include <memory>

#include "comm/communicator.h"

// What the handle points to.
struct DelrayCommunicator_ {
  std::unique_ptr<delray::comm::Communicator> ranks;
};
