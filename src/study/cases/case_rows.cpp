#include <algorithm>
#include <cmath>
#include <stdexcept>

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

std::vector<UnitRow> latin_hypercube(const SweepDesign& d, std::uint32_t number) {
  std::vector<UnitRow> rows(d.samples, UnitRow(d.variables.size()));
  for (std::size_t k = 0; k < d.variables.size(); ++k) {
    const std::vector<std::uint32_t> order = permutation(d.seed, stream_of(number, k, 1), d.samples);
    for (std::uint32_t r = 0; r < d.samples; ++r)
      rows[r][k] = (order[r] + uniform_draw(d.seed, stream_of(number, k, 0), r)) / d.samples;
  }
  return rows;
}

/// Trajectories of Morris 1991: from a point of the grid each variable moves once by half the levels, up or down, in an
/// order that is drawn. A level is the middle of its stratum, so that no distribution is asked for its ends.
std::vector<UnitRow> morris(const SweepDesign& d, std::uint32_t number) {
  const std::size_t n = d.variables.size();
  const int half = d.levels / 2;
  std::vector<UnitRow> rows;
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
      rows.push_back(std::move(row));
    };
    add();
    for (const auto& [draw, k] : order) {
      level[k] += step[k];
      add();
    }
  }
  return rows;
}

/// For each sample: a point a, a point b, and for each variable a with that variable of b.
std::vector<UnitRow> saltelli(const SweepDesign& d, std::uint32_t number) {
  const std::size_t n = d.variables.size();
  std::vector<UnitRow> rows;
  for (std::uint32_t r = 0; r < d.samples; ++r) {
    const UnitRow both = shifted_sobol(d, number, r, 2 * n);
    const auto middle = both.begin() + static_cast<std::ptrdiff_t>(n);
    rows.emplace_back(both.begin(), middle);
    rows.emplace_back(middle, both.end());
    for (std::size_t k = 0; k < n; ++k) {
      rows.emplace_back(both.begin(), middle);
      rows.back()[k] = both[n + k];
    }
  }
  return rows;
}

std::vector<Row> zipped(const SweepDesign& d) {
  std::vector<Row> rows(d.variables.front().values.size());
  for (std::size_t r = 0; r < rows.size(); ++r)
    for (const SweepVariable& v : d.variables) rows[r].push_back(v.values.at(r));
  return rows;
}

std::vector<Row> grid(const SweepDesign& d) {
  std::vector<Row> rows{{}};
  for (const SweepVariable& v : d.variables) {
    std::vector<Row> longer;
    for (const Row& row : rows)
      for (const SweepValue& x : v.values) {
        longer.push_back(row);
        longer.back().push_back(x);
      }
    rows = std::move(longer);
  }
  return rows;
}

std::vector<Row> one_at_a_time(const SweepDesign& d) {
  Row nominal;
  for (const SweepVariable& v : d.variables) nominal.push_back(*v.nominal);
  std::vector<Row> rows{nominal};
  for (std::size_t k = 0; k < d.variables.size(); ++k)
    for (const SweepValue& x : d.variables[k].values) {
      if (x.text == nominal[k].text) continue;  // this case exists already
      rows.push_back(nominal);
      rows.back()[k] = x;
    }
  return rows;
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
  if (d.kind == SweepDesignKind::latin_hypercube) return latin_hypercube(d, number);
  if (d.kind == SweepDesignKind::morris) return morris(d, number);
  if (d.kind == SweepDesignKind::saltelli) return saltelli(d, number);
  std::vector<UnitRow> rows;
  for (std::uint32_t r = 0; r < d.samples; ++r) {
    if (d.kind == SweepDesignKind::sobol) {
      rows.push_back(shifted_sobol(d, number, r, d.variables.size()));
      continue;
    }
    rows.emplace_back();
    for (std::size_t k = 0; k < d.variables.size(); ++k)
      rows.back().push_back(uniform_draw(d.seed, stream_of(number, k, 0), r));
  }
  return rows;
}

std::vector<Row> rows_of(const SweepDesign& d, std::uint32_t number) {
  switch (d.kind) {
    case SweepDesignKind::list:
    case SweepDesignKind::csv:
      return zipped(d);
    case SweepDesignKind::grid:
      return grid(d);
    case SweepDesignKind::one_at_a_time:
      return one_at_a_time(d);
    default:
      break;
  }
  std::vector<Row> rows;
  for (const UnitRow& u : unit_rows_of(d, number)) {
    rows.emplace_back();
    for (std::size_t k = 0; k < u.size(); ++k)
      rows.back().push_back(value_of(quantile(d.variables[k].distribution, u[k])));
  }
  return rows;
}

SweepCases make_cases(const io::SweepSpec& spec) {
  SweepCases made;
  double count = 1.0;
  for (const SweepDesign& d : spec.designs) {
    count *= count_of(d);
    for (const SweepVariable& v : d.variables) made.variables.push_back(v.name);
  }
  if (count > static_cast<double>(io::most_sweep_cases))
    throw std::runtime_error("the sweep has " + io::rounded_text(count, 3) + " cases, and at most " +
                             std::to_string(io::most_sweep_cases) + " are taken");
  std::vector<Row> all{{}};
  for (std::uint32_t i = 0; i < spec.designs.size(); ++i) {
    const std::vector<Row> rows = rows_of(spec.designs[i], i);
    std::vector<Row> longer;
    longer.reserve(all.size() * rows.size());
    for (const Row& first : all)
      for (const Row& second : rows) {
        longer.push_back(first);
        longer.back().insert(longer.back().end(), second.begin(), second.end());
      }
    all = std::move(longer);
  }
  const std::size_t width = std::to_string(all.size()).size();
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!is_kept(spec, made.variables, all[i])) {
      ++made.left_out;
      continue;
    }
    std::string name = std::to_string(i + 1);
    name.insert(0, width - name.size(), '0');
    made.cases.push_back({std::move(name), std::move(all[i])});
  }
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
