/// What the machine can do on one thread, to set beside the counters of bench_step: fused multiply-adds in registers, and reading from each cache
/// and from memory. Gflop/s and GB/s are the counters `flops` and `bytes`.
#include <benchmark/benchmark.h>

#include <vector>

#include "../../src/solve/lane_registers.hpp"
#include "../../src/solve/line_allocator.hpp"

namespace {

using namespace bough::solve;
using packs::load;
using packs::Real;

/// As many sums as a tile of the kernels has, so that none waits for itself.
void multiply_adds(benchmark::State& state) {
  constexpr int sums = 24, rounds = 1024;
  Real sum[sums] = {}, factor = Real{} + 0.5, term = Real{} + 1.0;
  for (auto _ : state) {
    for (int k = 0; k < rounds; ++k)
      for (Real& s : sum) s = packs::plus_product(term, s, factor);
    for (Real& s : sum) benchmark::DoNotOptimize(s);
  }
  state.counters["flops"] =
      benchmark::Counter(2.0 * packs::width * sums * rounds, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(multiply_adds);

void read(benchmark::State& state) {
  const std::vector<double, LineAllocator<double>> data(static_cast<std::size_t>(state.range(0)) * 128, 1.0);
  for (auto _ : state) {
    Real sum[8] = {};
    for (std::size_t i = 0; i < data.size(); i += 8 * packs::width)
      for (std::size_t j = 0; j < 8; ++j) sum[j] += load(data.data() + i + j * packs::width);
    for (Real& s : sum) benchmark::DoNotOptimize(s);
  }
  state.counters["bytes"] =
      benchmark::Counter(8.0 * static_cast<double>(data.size()), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(read)->ArgName("KiB")->Arg(16)->Arg(256)->Arg(4096)->Arg(262144);

}  // namespace
