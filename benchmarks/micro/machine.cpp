/// Peak performance of the machine on one thread, for comparison with the counters of bench_step: fused multiply-adds
/// in registers, and reading from each cache and from memory. Gflop/s and GB/s are the counters `flops` and `bytes`.
/// Rows second_thread/...: the same by one thread alone and by two side by side.
#include <benchmark/benchmark.h>

#include <vector>

#include "../../src/solve/line_allocator.hpp"
#include "../../src/solve/registers.hpp"
#include "../support/side_by_side.hpp"

namespace {

using namespace bough::solve;
using registers::Lanes;
using registers::load;

using Data = std::vector<double, LineAllocator<double>>;

/// Keeps only their total from being optimised away: sums with an address would be stored in memory every time.
template <int sums>
void keep(const Lanes (&sum)[sums]) {
  Lanes all = {};
#pragma GCC unroll 24
  for (int i = 0; i < sums; ++i) all += sum[i];
  benchmark::DoNotOptimize(all);
}

/// As many sums as a tile of the kernels has, so that no operation waits for the previous one on the same sum.
constexpr int many_sums = 3 * registers::width, rounds = 1024;
template <int sums>
void multiply_and_add() {
  Lanes sum[sums];
  for (int i = 0; i < sums; ++i) sum[i] = Lanes{} + i;  // the compiler would merge equal sums
  const Lanes factor = Lanes{} + 0.5, term = Lanes{} + 1.0;
  for (int k = 0; k < rounds; ++k)
#pragma GCC unroll 24
    for (int i = 0; i < sums; ++i) sum[i] = registers::add_product(sum[i], factor, term);
  keep(sum);
}

void read_all(const Data& data) {
  Lanes sum[8] = {};
  for (std::size_t i = 0; i < data.size(); i += 8 * registers::width)
#pragma GCC unroll 8
    for (std::size_t j = 0; j < 8; ++j) sum[j] += load(data.data() + i + j * registers::width);
  keep(sum);
}

Data make_data(std::int64_t kibibytes) { return Data(static_cast<std::size_t>(kibibytes) * 128, 1.0); }

void multiply_adds(benchmark::State& state) {
  for (auto _ : state) multiply_and_add<many_sums>();
  state.counters["flops"] =
      benchmark::Counter(2.0 * registers::width * many_sums * rounds, benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(multiply_adds);

void read(benchmark::State& state) {
  const Data data = make_data(state.range(0));
  for (auto _ : state) read_all(data);
  state.counters["bytes"] =
      benchmark::Counter(8.0 * static_cast<double>(data.size()), benchmark::Counter::kIsIterationInvariantRate);
}
BENCHMARK(read)->ArgName("KiB")->Arg(16)->Arg(256)->Arg(4096)->Arg(262144);

template <class Work>
void run_side_by_side(benchmark::State& state, long repeats, Work work) {
  bough::bench::SideBySide times;
  while (state.KeepRunningBatch(repeats)) times.add(state, repeats, work);
  times.report(state);
}

/// With one sum each operation waits for the previous one, and most of a core is idle. Two threads of one core do twice
/// as much of these, but no more of multiply_adds.
template <int sums>
void side_by_side_multiply_adds(benchmark::State& state) {
  run_side_by_side(state, 120000 / (sums + 4), [](int) { multiply_and_add<sums>(); });
}

void side_by_side_read(benchmark::State& state) {
  const Data data[2] = {make_data(state.range(0)), make_data(state.range(0))};
  const auto in_4_gib = static_cast<long>((std::int64_t{1} << 22) / state.range(0));
  run_side_by_side(state, in_4_gib, [&data](int k) { read_all(data[k]); });
}

constexpr int repetitions = 9;  // the median is reported, since the load of the host varies
BENCHMARK(side_by_side_multiply_adds<1>)
    ->Name("second_thread/dependent_multiply_adds")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->MinTime(0.05)
    ->Repetitions(repetitions);
BENCHMARK(side_by_side_multiply_adds<many_sums>)
    ->Name("second_thread/multiply_adds")
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->MinTime(0.05)
    ->Repetitions(repetitions);
BENCHMARK(side_by_side_read)
    ->Name("second_thread/read")
    ->ArgName("KiB")
    ->Arg(256)
    ->Arg(4096)
    ->Arg(262144)
    ->UseManualTime()
    ->Unit(benchmark::kMillisecond)
    ->MinTime(0.05)
    ->Repetitions(repetitions);

}  // namespace
