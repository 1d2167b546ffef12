#pragma once
/// Divides a batch into shards that run independently on machines that do not communicate.
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bough/io/sweep_spec.hpp"

namespace bough::study {

/// One shard of a batch: its number, from 1, and the count of shards.
struct Shard {
  std::size_t number = 1, count = 1;
  std::string origin;  ///< where the numbers come from: "the command line", "SLURM_ARRAY_TASK_ID"
};

/// "shard_003_of_020": name of the shard's folder within the folder common to all shards.
std::string folder_name(const Shard& shard);

/// Returns a variable of the environment; nullptr if it is not set.
using Environment = std::function<const char*(const char*)>;

/// Reads "3/20"; "auto": both numbers from the environment of Slurm arrays or Open MPI ranks; "auto/20": the number
/// from these or from indexed jobs of Kubernetes, which do not give the count. Throws std::runtime_error with an
/// explanation where the text is none of these, where two of these engines are present, and where a number is
/// uncertain: a Slurm array that does not begin at 0 or 1, or that omits numbers, may be part of another one that is
/// run again.
Shard read_shard(std::string_view text, const Environment& environment);

/// The shard of each case, from 0. Cases are assigned by decreasing work, each to the shard with the least work so far,
/// the first of equals. The result depends on the arguments alone, so that all shards agree on it.
std::vector<std::size_t> shards_of(const std::vector<double>& work, std::size_t count);

/// Predicted work of every row: unknowns times steps, or any other count. Each variable is first varied alone to find
/// out whether it changes the work. `look` is called once for all rows that agree in the variables that do.
std::vector<double> predicted_work(std::size_t count,
                                   const std::function<std::vector<io::SweepValue>(std::size_t)>& row_of,
                                   const std::function<double(const std::vector<io::SweepValue>&)>& look);

}  // namespace bough::study
