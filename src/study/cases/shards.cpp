#include "bough/study/shards.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <queue>
#include <stdexcept>
#include <unordered_map>

#include "bough/io/number_text.hpp"

namespace bough::study {
namespace {

constexpr double most_shards = 1e6;

/// Reads a whole number that consists of digits only.
std::optional<std::size_t> count_in(std::string_view text) {
  double x = 0.0;
  if (text.empty() || text.size() > 7 || text.find_first_not_of("0123456789") != std::string_view::npos ||
      !io::read_number(text, x) || x > most_shards)
    return std::nullopt;
  return static_cast<std::size_t>(x);
}

std::optional<std::size_t> count_in(const Environment& environment, const char* name) {
  const char* text = environment(name);
  if (text == nullptr) return std::nullopt;
  const std::optional<std::size_t> count = count_in(text);
  if (!count) throw std::runtime_error(std::string(name) + " is \"" + text + "\", which is no count");
  return count;
}

constexpr const char* what_to_do = "; give --shard I/N, with I from 1 to N";

/// A Slurm array may be part of another one that is run again. Its numbers identify shards only if they are complete.
Shard shard_of_slurm(const Environment& environment, std::optional<std::size_t> given_count) {
  const std::size_t id = *count_in(environment, "SLURM_ARRAY_TASK_ID");
  const auto first = count_in(environment, "SLURM_ARRAY_TASK_MIN"),
             last = count_in(environment, "SLURM_ARRAY_TASK_MAX"),
             count = count_in(environment, "SLURM_ARRAY_TASK_COUNT");
  if (!first || !last || !count)
    throw std::runtime_error(std::string("--shard auto: Slurm does not say how many tasks the array has") + what_to_do);
  if (*first > 1 || *last + 1 - *first != *count || id < *first || id > *last)
    throw std::runtime_error("--shard auto: the array goes from " + std::to_string(*first) + " to " +
                             std::to_string(*last) + " in " + std::to_string(*count) +
                             " tasks, so it may be a part of another one" + what_to_do);
  if (given_count && *given_count != *count)
    throw std::runtime_error("--shard auto/" + std::to_string(*given_count) + ": the array has " +
                             std::to_string(*count) + " tasks" + what_to_do);
  return {id - *first + 1, *count, "SLURM_ARRAY_TASK_ID"};
}

Shard shard_of_open_mpi(const Environment& environment, std::optional<std::size_t> given_count) {
  const auto rank = count_in(environment, "OMPI_COMM_WORLD_RANK"), size = count_in(environment, "OMPI_COMM_WORLD_SIZE");
  if (!size) throw std::runtime_error(std::string("--shard auto: OMPI_COMM_WORLD_SIZE is not set") + what_to_do);
  if (given_count && *given_count != *size)
    throw std::runtime_error("--shard auto/" + std::to_string(*given_count) + ": there are " + std::to_string(*size) +
                             " ranks" + what_to_do);
  return {*rank + 1, *size, "OMPI_COMM_WORLD_RANK"};
}

Shard shard_of_kubernetes(const Environment& environment, std::optional<std::size_t> given_count) {
  if (!given_count)
    throw std::runtime_error(
        "--shard auto: Kubernetes tells a job its index, but not how many there are; give --shard auto/N, with N its "
        "completions");
  return {*count_in(environment, "JOB_COMPLETION_INDEX") + 1, *given_count, "JOB_COMPLETION_INDEX"};
}

Shard shard_of_environment(const Environment& environment, std::optional<std::size_t> given_count) {
  using Reader = Shard (*)(const Environment&, std::optional<std::size_t>);
  const std::pair<const char*, Reader> engines[] = {{"SLURM_ARRAY_TASK_ID", shard_of_slurm},
                                                    {"OMPI_COMM_WORLD_RANK", shard_of_open_mpi},
                                                    {"JOB_COMPLETION_INDEX", shard_of_kubernetes}};
  Reader reader = nullptr;
  std::string found;
  for (const auto& [name, read] : engines) {
    if (environment(name) == nullptr) continue;
    found += (found.empty() ? "" : " and ") + std::string(name);
    if (reader != nullptr) throw std::runtime_error("--shard auto: both " + found + " are set" + what_to_do);
    reader = read;
  }
  if (reader == nullptr)
    throw std::runtime_error(
        std::string("--shard auto: none of SLURM_ARRAY_TASK_ID, OMPI_COMM_WORLD_RANK and JOB_COMPLETION_INDEX is set") +
        what_to_do);
  return reader(environment, given_count);
}

}  // namespace

std::string folder_name(const Shard& shard) {
  const auto padded = [](std::size_t n) {
    std::string text = std::to_string(n);
    return text.insert(0, text.size() < 3 ? 3 - text.size() : 0, '0');
  };
  return "shard_" + padded(shard.number) + "_of_" + padded(shard.count);
}

Shard read_shard(std::string_view text, const Environment& environment) {
  const std::size_t slash = text.find('/');
  const std::string_view first = text.substr(0, slash);
  std::optional<std::size_t> count;
  if (slash != std::string_view::npos) count = count_in(text.substr(slash + 1));
  const bool is_whole = slash == std::string_view::npos ? first == "auto" : count.has_value() && *count > 0;
  if (is_whole && first == "auto") {
    Shard shard = shard_of_environment(environment, count);
    if (shard.number <= shard.count) return shard;
    throw std::runtime_error(shard.origin + " is that of shard " + std::to_string(shard.number) + ", and there are " +
                             std::to_string(shard.count) + what_to_do);
  }
  const std::optional<std::size_t> number = count_in(first);
  if (!is_whole || !number || *number < 1 || *number > *count)
    throw std::runtime_error("--shard " + std::string(text) + ": this is not I/N with I from 1 to N, auto or auto/N");
  return {*number, *count, "the command line"};
}

std::vector<std::size_t> shards_of(const std::vector<double>& work, std::size_t count) {
  std::vector<std::size_t> order(work.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return work[a] > work[b]; });
  using Load = std::pair<double, std::size_t>;
  std::priority_queue<Load, std::vector<Load>, std::greater<>> loads;  // least first, then the first of equals
  for (std::size_t s = 0; s < count; ++s) loads.emplace(0.0, s);
  const double least = work.empty() ? 0.0 : 1e-6 * work[order.front()];  // cases without predicted work are
                                                                         // distributed, too
  std::vector<std::size_t> shards(work.size());
  for (const std::size_t i : order) {
    const auto [load, shard] = loads.top();
    loads.pop();
    shards[i] = shard;
    loads.emplace(load + std::max({work[i], least, 1e-300}), shard);
  }
  return shards;
}

namespace {

using Row = std::vector<io::SweepValue>;

/// Some of the values of a variable, the first and the last among them.
std::vector<io::SweepValue> some_values(std::size_t count, const std::function<Row(std::size_t)>& row_of,
                                        std::size_t variable) {
  constexpr std::size_t most = 9;
  std::vector<io::SweepValue> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(std::move(row_of(i)[variable]));
  const auto less = [](const io::SweepValue& a, const io::SweepValue& b) {
    return a.number && b.number ? *a.number < *b.number : a.text < b.text;
  };
  const bool are_numbers =
      std::all_of(values.begin(), values.end(), [](const auto& v) { return v.number.has_value(); });
  if (!are_numbers)
    for (io::SweepValue& v : values) v.number.reset();
  std::sort(values.begin(), values.end(), less);
  values.erase(std::unique(values.begin(), values.end(), [](const auto& a, const auto& b) { return a.text == b.text; }),
               values.end());
  if (values.size() <= most) return values;
  std::vector<io::SweepValue> some;
  for (std::size_t k = 0; k < most; ++k) some.push_back(values[k * (values.size() - 1) / (most - 1)]);
  return some;
}

}  // namespace

std::vector<double> predicted_work(std::size_t count, const std::function<Row(std::size_t)>& row_of,
                                   const std::function<double(const Row&)>& look) {
  std::vector<double> work;
  if (count == 0) return work;
  std::vector<std::size_t> deciding;
  const Row first = row_of(0), last = row_of(count - 1);
  const double of_first = look(first), of_last = look(last);
  for (std::size_t k = 0; k < first.size(); ++k) {
    const std::vector<io::SweepValue> values = some_values(count, row_of, k);
    const auto changes = [&](const Row& base, double of_base) {
      return std::any_of(values.begin(), values.end(), [&](const io::SweepValue& value) {
        Row row = base;
        row[k] = value;
        return look(row) != of_base;
      });
    };
    if (changes(first, of_first) || changes(last, of_last)) deciding.push_back(k);
  }
  std::unordered_map<std::string, double> known;
  for (std::size_t i = 0; i < count; ++i) {
    const Row row = row_of(i);
    std::string key;
    for (const std::size_t k : deciding) key += row[k].text + '\n';
    const auto [at, is_new] = known.try_emplace(key, 0.0);
    if (is_new) at->second = look(row);
    work.push_back(at->second);
  }
  return work;
}

}  // namespace bough::study
