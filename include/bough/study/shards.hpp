#pragma once
/// A batch in parts that run by themselves, on machines that know nothing of each other: which cases a part has.
#include <cstddef>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "bough/io/sweep_spec.hpp"

namespace bough::study {

/// One part of a batch: number of count, from 1.
struct Shard {
  std::size_t number = 1, count = 1;
  std::string origin;  ///< where the numbers come from: "the command line", "SLURM_ARRAY_TASK_ID"
};

/// "shard_003_of_020": below the folder that all shards are given.
std::string folder_name(const Shard& shard);

/// A variable of the environment; nullptr: it is not set.
using Environment = std::function<const char*(const char*)>;

/// "3/20"; "auto": both numbers from the environment of Slurm arrays, Open MPI ranks; "auto/20": the number from these
/// or from indexed jobs of Kubernetes, which do not tell how many there are. Throws std::runtime_error in words where
/// the text is neither, where two of these engines are there, and where a number is not known for sure: an array that
/// does not begin at 0 or 1, or leaves numbers out, may be a part of another one that is run again.
Shard read_shard(std::string_view text, const Environment& environment);

/// The shard of each case, from 0: the largest work first, each to the shard that has least so far, the first of
/// equals. A function of the counts alone, so that all shards find the same.
std::vector<std::size_t> shards_of(const std::vector<double>& work, std::size_t count);

/// Predicted work of every row: unknowns times steps, or any other count. Variables that do not change it, as far as
/// probing each of them alone tells, are not looked at again: `look` is called once for all rows that agree in the
/// others.
std::vector<double> predicted_work(const std::vector<std::vector<io::SweepValue>>& rows,
                                   const std::function<double(const std::vector<io::SweepValue>&)>& look);

}  // namespace bough::study
