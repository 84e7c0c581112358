// Gauss-Newton on the logarithms of four factors: errors and, by differences, slopes come from
// simulations of every sample.
//
// An error far off weighs as its direction alone (Huber 1964), and a light pull towards the start
// keeps the equations solvable where samples do not tell factors apart. Four iterations of five
// simulations a sample.
//
// Degenerate: without samples the start is returned; factors stay within 30 up or down.
#include "composite/fit_machine.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace delray::composite {
namespace {

constexpr std::size_t kFactors = 4;
using Factors = std::array<double, kFactors>;  // logarithms

MachineModel scaled(const MachineModel& start, const Factors& logarithms) {
  MachineModel model = start;
  model.network.overhead *= std::exp(logarithms[0]);
  for (double LayerCosts::*cost :
       {&LayerCosts::encode, &LayerCosts::encode_pixel, &LayerCosts::encode_byte}) {
    model.costs.*cost *= std::exp(logarithms[1]);
  }
  for (double LayerCosts::*cost :
       {&LayerCosts::merge, &LayerCosts::merge_pixel, &LayerCosts::merge_covered}) {
    model.costs.*cost *= std::exp(logarithms[2]);
  }
  model.network.latency *= std::exp(logarithms[3]);
  return model;
}

// log(simulated / measured) of all samples.
std::vector<double> errors_of(const MachineModel& model, std::span<const TimedScheme> samples) {
  std::vector<double> errors;
  for (const TimedScheme& sample : samples) {
    const double seconds =
        simulate(sample.scheme, sample.images, model, sample.options).compose_seconds;
    errors.push_back(std::log(std::max(seconds, 1e-9) / sample.seconds));
  }
  return errors;
}

// Solves matrix * x = right by elimination. REQUIRES: the matrix is positive definite.
Factors solve(std::array<Factors, kFactors> matrix, Factors right) {
  for (std::size_t k = 0; k < kFactors; ++k) {
    for (std::size_t i = k + 1; i < kFactors; ++i) {
      const double factor = matrix[i][k] / matrix[k][k];
      for (std::size_t j = k; j < kFactors; ++j) matrix[i][j] -= factor * matrix[k][j];
      right[i] -= factor * right[k];
    }
  }
  for (std::size_t k = kFactors; k-- > 0;) {
    for (std::size_t j = k + 1; j < kFactors; ++j) right[k] -= matrix[k][j] * right[j];
    right[k] /= matrix[k][k];
  }
  return right;
}

}  // namespace

MachineModel fit_machine(const MachineModel& start, std::span<const TimedScheme> samples) {
  constexpr int kIterations = 4;
  constexpr double kStep = 0.1, kPull = 0.02, kFar = 0.15;
  const double kMost = std::log(30.0);
  Factors at{};
  for (int iteration = 0; iteration < kIterations && !samples.empty(); ++iteration) {
    const std::vector<double> errors = errors_of(scaled(start, at), samples);
    std::array<std::vector<double>, kFactors> slopes;
    for (std::size_t k = 0; k < kFactors; ++k) {
      Factors moved = at;
      moved[k] += kStep;
      slopes[k] = errors_of(scaled(start, moved), samples);
      for (std::size_t i = 0; i < errors.size(); ++i) {
        slopes[k][i] = (slopes[k][i] - errors[i]) / kStep;
      }
    }
    std::array<Factors, kFactors> matrix{};
    Factors right{};
    double pull = 0;
    for (const TimedScheme& sample : samples) pull += kPull * sample.weight;
    for (std::size_t k = 0; k < kFactors; ++k) {
      for (std::size_t i = 0; i < errors.size(); ++i) {
        // A sample that lies far off, by chance or for a reason outside of the model, pulls no
        // harder than an error of kFar (Huber 1964).
        const double slope = slopes[k][i] * samples[i].weight *
                             std::min(1.0, kFar / std::max(std::abs(errors[i]), kFar));
        right[k] -= slope * errors[i];
        for (std::size_t j = 0; j < kFactors; ++j) matrix[k][j] += slope * slopes[j][i];
      }
      matrix[k][k] += pull;
      right[k] -= pull * at[k];
    }
    const Factors step = solve(matrix, right);
    for (std::size_t k = 0; k < kFactors; ++k) at[k] = std::clamp(at[k] + step[k], -kMost, kMost);
  }
  return scaled(start, at);
}

}  // namespace delray::composite
