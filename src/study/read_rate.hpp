#pragma once
/// How fast threads read memory. Internal to study.
#include <cstddef>
#include <vector>

namespace bough::study {

/// Rates [bytes/s] at which 1, 2 ... of `threads` together read an array of `bytes`, each its own part, again and
/// again: the best of five trials of some milliseconds. An array that fits into the caches is read from there. Counts
/// above `most_threads` get the rate of `most_threads`; a larger count never gets a smaller rate. At most 256 MB are
/// taken, since larger arrays are read from memory at the same rate.
std::vector<double> measure_read_rates(std::size_t bytes, const std::vector<int>& threads, int most_threads);

}  // namespace bough::study
