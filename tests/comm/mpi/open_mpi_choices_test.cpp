#include "comm/mpi/open_mpi_choices.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <optional>
#include <string>

namespace delray::comm::internal {
namespace {

constexpr std::array kVariables = {"OMPI_COMM_WORLD_LOCAL_SIZE", "OMPI_COMM_WORLD_SIZE",
                                   "OMPI_MCA_mtl", "OMPI_MCA_pml"};
using Values = std::array<const char*, kVariables.size()>;  // null: not set

std::optional<std::string> value_of(const char* variable) {
  const char* value = std::getenv(variable);
  return value == nullptr ? std::nullopt : std::optional<std::string>(value);
}

void set(const char* variable, const char* value) {
  value == nullptr ? unsetenv(variable) : setenv(variable, value, 1);
}

// OMPI_MCA_pml after choose_for_open_mpi(), with these values of the variables; leaves the
// environment as it was.
std::optional<std::string> chosen_with(const Values& values) {
  std::array<std::optional<std::string>, kVariables.size()> before;
  for (std::size_t i = 0; i < kVariables.size(); ++i) {
    before[i] = value_of(kVariables[i]);
    set(kVariables[i], values[i]);
  }
  choose_for_open_mpi();
  const auto chosen = value_of("OMPI_MCA_pml");
  for (std::size_t i = 0; i < kVariables.size(); ++i) {
    set(kVariables[i], before[i] ? before[i]->c_str() : nullptr);
  }
  return chosen;
}

TEST(OpenMpiChoices, OneMachineNeedsNoNetwork) {
  EXPECT_EQ(chosen_with({"2", "2", nullptr, nullptr}), "ob1");
}

TEST(OpenMpiChoices, SeveralMachinesUseWhatOpenMpiFinds) {
  EXPECT_EQ(chosen_with({"2", "4", nullptr, nullptr}), std::nullopt);
  EXPECT_EQ(chosen_with({nullptr, nullptr, nullptr, nullptr}), std::nullopt);
  EXPECT_EQ(chosen_with({nullptr, "2", nullptr, nullptr}), std::nullopt);
}

TEST(OpenMpiChoices, TheUsersChoiceStands) {
  EXPECT_EQ(chosen_with({"2", "2", nullptr, "ucx"}), "ucx");
  EXPECT_EQ(chosen_with({"2", "2", "psm2", nullptr}), std::nullopt);
}

}  // namespace
}  // namespace delray::comm::internal
