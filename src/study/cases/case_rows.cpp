#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include "bough/io/number_text.hpp"
#include "bough/study/cases.hpp"
#include "bough/study/sampling.hpp"

namespace bough::study {

using io::SweepDesign;
using io::SweepDesignKind;
using io::SweepValue;
using io::SweepVariable;

namespace {

using Row = std::vector<SweepValue>;
using UnitRow = std::vector<double>;

constexpr int digits = 12;  // of random values: on so many digits all mathematical libraries agree

SweepValue value_of(double x) {
  SweepValue value{io::rounded_text(x, digits), {}};
  double read = 0.0;
  (void)io::read_number(value.text, read);
  value.number = read;
  return value;
}

/// Numbers of random streams: several for each variable of each design, for different purposes.
std::uint32_t stream_of(std::uint32_t design, std::size_t variable, std::uint32_t use) {
  return (design * 1000u + static_cast<std::uint32_t>(variable)) * 4u + use;
}

double part(double x) {
  const double u = x - std::floor(x);
  return u > 0.0 ? u : 0x1p-33;  // quantiles need an argument above 0
}

/// Of Sobol's sequence, moved by one draw a dimension (Cranley, Patterson 1976).
UnitRow shifted_sobol(const SweepDesign& d, std::uint32_t number, std::uint32_t row, std::size_t dimensions) {
  UnitRow u(dimensions);
  for (std::size_t k = 0; k < dimensions; ++k)
    u[k] = part(sobol_point(row, k) + uniform_draw(d.seed, stream_of(number, k, 0), 0));
  return u;
}

using TakeUnitRow = std::function<void(const UnitRow&)>;

void latin_hypercube(const SweepDesign& d, std::uint32_t number, const TakeUnitRow& take) {
  std::vector<std::vector<std::uint32_t>> orders;
  for (std::size_t k = 0; k < d.variables.size(); ++k)
    orders.push_back(permutation(d.seed, stream_of(number, k, 1), d.samples));
  UnitRow row(d.variables.size());
  for (std::uint32_t r = 0; r < d.samples; ++r) {
    for (std::size_t k = 0; k < row.size(); ++k)
      row[k] = (orders[k][r] + uniform_draw(d.seed, stream_of(number, k, 0), r)) / d.samples;
    take(row);
  }
}

/// Trajectories of Morris 1991: from a point of the grid each variable moves once by half the levels, up or down, in an
/// order that is drawn. A level is the middle of its stratum, so that no distribution is asked for its ends.
void morris(const SweepDesign& d, std::uint32_t number, const TakeUnitRow& take) {
  const std::size_t n = d.variables.size();
  const int half = d.levels / 2;
  for (std::uint32_t trajectory = 0; trajectory < d.samples; ++trajectory) {
    std::vector<int> level(n), step(n);
    std::vector<std::pair<double, std::size_t>> order(n);
    for (std::size_t k = 0; k < n; ++k) {
      const auto draw = [&](std::uint32_t use) { return uniform_draw(d.seed, stream_of(number, k, use), trajectory); };
      const bool goes_down = draw(1) < 0.5;
      level[k] = static_cast<int>(draw(0) * half) + (goes_down ? half : 0);
      step[k] = goes_down ? -half : half;
      order[k] = {draw(2), k};
    }
    std::sort(order.begin(), order.end());
    const auto add = [&] {
      UnitRow row(n);
      for (std::size_t k = 0; k < n; ++k) row[k] = (level[k] + 0.5) / d.levels;
      take(row);
    };
    add();
    for (const auto& [draw, k] : order) {
      level[k] += step[k];
      add();
    }
  }
}

/// For each sample: a point a, a point b, and for each variable a with that variable of b.
void saltelli(const SweepDesign& d, std::uint32_t number, const TakeUnitRow& take) {
  const std::size_t n = d.variables.size();
  for (std::uint32_t r = 0; r < d.samples; ++r) {
    const UnitRow both = shifted_sobol(d, number, r, 2 * n);
    const auto middle = both.begin() + static_cast<std::ptrdiff_t>(n);
    const UnitRow first(both.begin(), middle);
    take(first);
    take({middle, both.end()});
    for (std::size_t k = 0; k < n; ++k) {
      UnitRow mixed = first;
      mixed[k] = both[n + k];
      take(mixed);
    }
  }
}

void for_each_unit_row(const SweepDesign& d, std::uint32_t number, const TakeUnitRow& take) {
  if (d.kind == SweepDesignKind::latin_hypercube) return latin_hypercube(d, number, take);
  if (d.kind == SweepDesignKind::morris) return morris(d, number, take);
  if (d.kind == SweepDesignKind::saltelli) return saltelli(d, number, take);
  UnitRow row(d.variables.size());
  for (std::uint32_t r = 0; r < d.samples; ++r) {
    if (d.kind == SweepDesignKind::sobol)
      row = shifted_sobol(d, number, r, d.variables.size());
    else
      for (std::size_t k = 0; k < row.size(); ++k) row[k] = uniform_draw(d.seed, stream_of(number, k, 0), r);
    take(row);
  }
}

using TakeRow = std::function<void(const Row&)>;

void zipped(const SweepDesign& d, const TakeRow& take) {
  Row row(d.variables.size());
  for (std::size_t r = 0; r < d.variables.front().values.size(); ++r) {
    for (std::size_t k = 0; k < row.size(); ++k) row[k] = d.variables[k].values.at(r);
    take(row);
  }
}

/// All combinations, the last variable fastest.
void grid(const SweepDesign& d, const TakeRow& take) {
  Row row(d.variables.size());
  const std::function<void(std::size_t)> vary = [&](std::size_t k) {
    if (k == row.size()) return take(row);
    for (const SweepValue& x : d.variables[k].values) {
      row[k] = x;
      vary(k + 1);
    }
  };
  vary(0);
}

void one_at_a_time(const SweepDesign& d, const TakeRow& take) {
  Row nominal;
  for (const SweepVariable& v : d.variables) nominal.push_back(*v.nominal);
  take(nominal);
  for (std::size_t k = 0; k < d.variables.size(); ++k)
    for (const SweepValue& x : d.variables[k].values) {
      if (x.text == nominal[k].text) continue;  // this case exists already
      Row row = nominal;
      row[k] = x;
      take(row);
    }
}

/// Number of rows of a design, computed before any row is made.
double count_of(const SweepDesign& d) {
  const double n = static_cast<double>(d.variables.size()), samples = d.samples;
  double product = 1.0, sum = 1.0;
  for (const SweepVariable& v : d.variables) {
    product *= static_cast<double>(v.values.size());
    sum += static_cast<double>(v.values.size());
  }
  switch (d.kind) {
    case SweepDesignKind::list:
    case SweepDesignKind::csv:
      return static_cast<double>(d.variables.front().values.size());
    case SweepDesignKind::grid:
      return product;
    case SweepDesignKind::one_at_a_time:
      return sum;
    case SweepDesignKind::morris:
      return samples * (n + 1.0);
    case SweepDesignKind::saltelli:
      return samples * (n + 2.0);
    default:
      return samples;
  }
}

bool is_kept(const io::SweepSpec& spec, const std::vector<std::string>& variables, const Row& inputs) {
  return std::all_of(spec.where.begin(), spec.where.end(), [&](const io::SweepCondition& c) {
    std::vector<double> values;
    for (const std::string& name : c.names) {
      const auto at = static_cast<std::size_t>(std::find(variables.begin(), variables.end(), name) - variables.begin());
      values.push_back(inputs[at].number.value_or(std::nan("")));
    }
    const double x = c.formula(values);
    return (!c.low || x >= *c.low) && (!c.high || x <= *c.high) && !std::isnan(x);
  });
}

}  // namespace

std::vector<UnitRow> unit_rows_of(const SweepDesign& d, std::uint32_t number) {
  std::vector<UnitRow> rows;
  for_each_unit_row(d, number, [&rows](const UnitRow& row) { rows.push_back(row); });
  return rows;
}

void for_each_row(const SweepDesign& d, std::uint32_t number, const TakeRow& take) {
  switch (d.kind) {
    case SweepDesignKind::list:
    case SweepDesignKind::csv:
      return zipped(d, take);
    case SweepDesignKind::grid:
      return grid(d, take);
    case SweepDesignKind::one_at_a_time:
      return one_at_a_time(d, take);
    default:
      break;
  }
  Row row(d.variables.size());
  for_each_unit_row(d, number, [&](const UnitRow& u) {
    for (std::size_t k = 0; k < u.size(); ++k) row[k] = value_of(quantile(d.variables[k].distribution, u[k]));
    take(row);
  });
}

std::string SweepCases::name(std::size_t i) const {
  std::string name = std::to_string(numbers_[i] + 1);
  const std::size_t width = std::to_string(all_).size();
  return name.insert(0, width - name.size(), '0');
}

std::vector<SweepValue> SweepCases::inputs(std::size_t i) const {
  std::vector<SweepValue> values;
  for (std::size_t k = i * variables_.size(); k < (i + 1) * variables_.size(); ++k) {
    const std::uint32_t word = words_.empty() ? 0 : words_[k];
    values.push_back(word == 0 ? value_of(cells_[k]) : values_[word - 1]);
  }
  return values;
}

SweepCases::Cell SweepCases::cell_of(const SweepValue& value) {
  if (value.number && value_of(*value.number).text == value.text) return {*value.number, 0};
  const auto [at, is_new] = word_of_.try_emplace(value.text, static_cast<std::uint32_t>(values_.size() + 1));
  if (is_new) values_.push_back(value);
  return {0.0, at->second};
}

void SweepCases::add(const std::vector<SweepValue>& inputs) {
  numbers_.push_back(static_cast<std::uint32_t>(all_++));
  for (std::size_t k = 0; k < inputs.size(); ++k) {
    cells_.push_back(0.0);
    if (!words_.empty()) words_.push_back(0);
    set(numbers_.size() - 1, k, inputs[k]);
  }
}

void SweepCases::set(std::size_t i, std::size_t variable, const SweepValue& value) {
  const std::size_t at = i * variables_.size() + variable;
  const Cell cell = cell_of(value);
  cells_[at] = cell.number;
  if (words_.empty() && cell.word != 0) words_.resize(cells_.size());
  if (!words_.empty()) words_[at] = cell.word;
}

SweepCases make_cases(const io::SweepSpec& spec) {
  std::vector<std::string> variables;
  double count = 1.0;
  for (const SweepDesign& d : spec.designs) {
    count *= count_of(d);
    for (const SweepVariable& v : d.variables) variables.push_back(v.name);
  }
  if (count > static_cast<double>(io::most_sweep_cases))
    throw std::runtime_error("the sweep has " + io::rounded_text(count, 3) + " cases, and at most " +
                             std::to_string(io::most_sweep_cases) + " are taken");
  const std::function<void(std::size_t, const Row&, const TakeRow&)> combine = [&](std::size_t design, const Row& first,
                                                                                   const TakeRow& take) {
    if (design == spec.designs.size()) return take(first);
    for_each_row(spec.designs[design], static_cast<std::uint32_t>(design), [&](const Row& second) {
      Row longer = first;
      longer.insert(longer.end(), second.begin(), second.end());
      combine(design + 1, longer, take);
    });
  };
  SweepCases made(variables);
  combine(0, {}, [&](const Row& row) {
    if (is_kept(spec, variables, row))
      made.add(row);
    else
      made.leave_out();
  });
  return made;
}

std::vector<std::string> overrides_of(const io::SweepSpec& spec, const SweepCase& which) {
  std::vector<std::string> overrides = spec.overrides;
  std::size_t k = 0;
  for (const SweepDesign& d : spec.designs)
    for (const SweepVariable& v : d.variables) {
      for (const std::string& pointer : v.pointers) overrides.push_back(pointer + "=" + which.inputs[k].text);
      ++k;
    }
  return overrides;
}

}  // namespace bough::study
