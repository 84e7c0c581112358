// Behind DelrayCommunicator.
#pragma once

#include <memory>

#include "comm/communicator.h"

struct DelrayCommunicator_ {
  std::unique_ptr<delray::comm::Communicator> ranks;
};
