#include "bough/study/sensitivity.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "bough/study/cases.hpp"
#include "bough/study/sampling.hpp"

namespace bough::study {
namespace {

using Values = std::span<const std::optional<double>>;

bool are_there(Values values, std::size_t first, std::size_t count) {
  for (std::size_t k = first; k < first + count; ++k)
    if (k >= values.size() || !values[k]) return false;
  return true;
}

double mean(const std::vector<double>& x) {
  return std::accumulate(x.begin(), x.end(), 0.0) / static_cast<double>(x.size());
}

/// Whether the spread of the values is round-off.
bool is_constant(const std::vector<double>& x) {
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  return !(*high - *low > 1e-14 * std::max(std::abs(*low), std::abs(*high)));
}

/// Ranks from 1; equal values share the mean of theirs.
std::vector<double> ranks_of(const std::vector<double>& x) {
  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&x](std::size_t a, std::size_t b) { return x[a] < x[b]; });
  std::vector<double> ranks(x.size());
  for (std::size_t first = 0; first < order.size();) {
    std::size_t last = first;
    while (last + 1 < order.size() && x[order[last + 1]] == x[order[first]]) ++last;
    for (std::size_t k = first; k <= last; ++k) ranks[order[k]] = 1.0 + 0.5 * static_cast<double>(first + last);
    first = last + 1;
  }
  return ranks;
}

/// Minus the mean, divided by the standard deviation; all zero for a constant.
Eigen::VectorXd standardised(const std::vector<double>& x) {
  Eigen::VectorXd v = Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size()));
  if (is_constant(x)) return Eigen::VectorXd::Zero(v.size());
  v.array() -= v.mean();
  return v / std::sqrt(v.squaredNorm() / static_cast<double>(v.size()));
}

struct Fit {
  Eigen::VectorXd coefficients;
  double explained = 0.0;
};

Fit fit(const std::vector<std::vector<double>>& columns, const std::vector<double>& y) {
  Eigen::MatrixXd A(static_cast<Eigen::Index>(y.size()), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) A.col(static_cast<Eigen::Index>(k)) = standardised(columns[k]);
  const Eigen::VectorXd b = standardised(y);
  const Eigen::VectorXd x = A.completeOrthogonalDecomposition().solve(b);
  return {x, 1.0 - (b - A * x).squaredNorm() / b.squaredNorm()};
}

}  // namespace

std::optional<Sensitivity> morris_effects(const std::vector<std::vector<double>>& rows, Values values) {
  if (rows.empty()) return std::nullopt;
  const std::size_t n = rows.front().size();
  std::vector<std::vector<double>> effects(n);
  Sensitivity s{"morris", {"mu", "mu_star", "sigma"}, {}, 0, {}, {}};
  for (std::size_t first = 0; first + n < rows.size(); first += n + 1) {
    if (!are_there(values, first, n + 1)) continue;  // a trajectory is used only if it is complete
    s.rows += n + 1;
    for (std::size_t r = first + 1; r <= first + n; ++r)
      for (std::size_t k = 0; k < n; ++k)
        if (const double step = rows[r][k] - rows[r - 1][k]; step != 0.0)
          effects[k].push_back((*values[r] - *values[r - 1]) / step);
  }
  if (effects.empty() || effects.front().size() < 2) return std::nullopt;
  s.values.assign(3, std::vector<Index>(n));
  for (std::size_t k = 0; k < n; ++k) {
    const double mu = mean(effects[k]);
    double magnitudes = 0.0, squares = 0.0;
    for (const double e : effects[k]) {
      magnitudes += std::abs(e);
      squares += (e - mu) * (e - mu);
    }
    const double count = static_cast<double>(effects[k].size());
    s.values[0][k].value = mu;
    s.values[1][k].value = magnitudes / count;
    s.values[2][k].value = std::sqrt(squares / (count - 1.0));
  }
  return s;
}

std::optional<Sensitivity> regression(const std::vector<std::vector<double>>& inputs, Values values) {
  if (inputs.empty()) return std::nullopt;
  const std::size_t n = inputs.front().size();
  std::vector<std::vector<double>> columns(n);
  std::vector<double> y;
  for (std::size_t r = 0; r < inputs.size() && r < values.size(); ++r) {
    if (!values[r]) continue;
    y.push_back(*values[r]);
    for (std::size_t k = 0; k < n; ++k) columns[k].push_back(inputs[r][k]);
  }
  if (y.size() < n + 2 || is_constant(y)) return std::nullopt;
  Sensitivity s{"regression", {"src", "srrc"}, {}, y.size(), {}, {}};
  const Fit of_values = fit(columns, y);
  for (std::vector<double>& c : columns) c = ranks_of(c);
  const Fit of_ranks = fit(columns, ranks_of(y));
  for (const Fit* f : {&of_values, &of_ranks}) {
    s.values.emplace_back(n);
    for (std::size_t k = 0; k < n; ++k) s.values.back()[k].value = f->coefficients[static_cast<Eigen::Index>(k)];
  }
  s.explained = of_values.explained;
  s.explained_ranks = of_ranks.explained;
  return s;
}

namespace {

/// Samples that have all their values: f(a), f(b) and f(ab_i), less the mean.
struct SobolSamples {
  std::vector<double> a, b;
  std::vector<std::vector<double>> ab;  ///< by variable
};

SobolSamples samples_of(std::size_t n, Values values) {
  SobolSamples f;
  f.ab.resize(n);
  for (std::size_t first = 0; first + n + 2 <= values.size(); first += n + 2) {
    if (!are_there(values, first, n + 2)) continue;
    f.a.push_back(*values[first]);
    f.b.push_back(*values[first + 1]);
    for (std::size_t k = 0; k < n; ++k) f.ab[k].push_back(*values[first + 2 + k]);
  }
  if (f.a.empty()) return f;
  const double middle = 0.5 * (mean(f.a) + mean(f.b));
  for (std::vector<double>* list : {&f.a, &f.b})
    for (double& x : *list) x -= middle;
  for (std::vector<double>& list : f.ab)
    for (double& x : list) x -= middle;
  return f;
}

/// First and total indices of all variables over some of the samples.
std::vector<double> indices_over(const SobolSamples& f, const std::vector<std::uint32_t>& chosen) {
  double sum = 0.0, squares = 0.0;
  for (const std::uint32_t s : chosen) {
    sum += f.a[s] + f.b[s];
    squares += f.a[s] * f.a[s] + f.b[s] * f.b[s];
  }
  const double count = static_cast<double>(chosen.size()), middle = sum / (2.0 * count);
  const double variance = squares / (2.0 * count) - middle * middle;
  std::vector<double> indices;
  for (const std::vector<double>& ab : f.ab) {
    double first = 0.0, total = 0.0;
    for (const std::uint32_t s : chosen) {
      first += (f.b[s] - middle) * (ab[s] - f.a[s]);
      total += (f.a[s] - ab[s]) * (f.a[s] - ab[s]);
    }
    indices.push_back(first / count / variance);
    indices.push_back(0.5 * total / count / variance);
  }
  return indices;
}

}  // namespace

std::optional<Sensitivity> sobol_indices(std::size_t n, Values values, std::uint64_t seed) {
  constexpr std::size_t resamples = 1000;
  const SobolSamples f = samples_of(n, values);
  const std::size_t count = f.a.size();
  if (count < 4 || is_constant(f.a)) return std::nullopt;
  std::vector<std::uint32_t> chosen(count);
  std::iota(chosen.begin(), chosen.end(), 0u);
  const std::vector<double> best = indices_over(f, chosen);
  std::vector<std::vector<double>> spread(best.size());
  for (std::size_t r = 0; r < resamples; ++r) {
    for (std::size_t k = 0; k < count; ++k)
      chosen[k] = static_cast<std::uint32_t>(std::min(
          static_cast<double>(count - 1), uniform_draw(seed, 0xffffu, r * count + k) * static_cast<double>(count)));
    const std::vector<double> again = indices_over(f, chosen);
    for (std::size_t i = 0; i < again.size(); ++i)
      if (std::isfinite(again[i])) spread[i].push_back(again[i]);
  }
  Sensitivity s{"sobol_indices", {"first", "total"}, {}, count * (n + 2), {}, {}};
  s.values.assign(2, std::vector<Index>(n));
  for (std::size_t i = 0; i < best.size(); ++i) {
    Index& index = s.values[i % 2][i / 2];
    index.value = best[i];
    std::sort(spread[i].begin(), spread[i].end());
    if (spread[i].size() < resamples / 2) continue;
    const auto at = [&](double part) {
      return spread[i][static_cast<std::size_t>(part * static_cast<double>(spread[i].size() - 1))];
    };
    index.low = at(0.025);
    index.high = at(0.975);
  }
  return s;
}

std::vector<MeasureSensitivity> sensitivities_of(const io::SweepSpec& spec, const CaseTable& results) {
  if (spec.designs.size() != 1) return {};
  const io::SweepDesign& design = spec.designs.front();
  std::vector<std::string> variables;
  for (const io::SweepVariable& v : design.variables) variables.push_back(v.name);
  std::size_t num_rows = 0;
  for_each_row(design, 0, [&num_rows](const auto&) { ++num_rows; });
  std::vector<std::size_t> row_of;
  for (std::size_t i = 0; i < results.size(); ++i)
    row_of.push_back(std::stoul(results.cases().at(i).name) - 1);  // the name of a case is its number
  std::vector<MeasureSensitivity> all;
  for (const CaseTable::Measure& measure : results.measures()) {
    if (measure.name.ends_with(error_ending)) continue;
    const std::vector<std::optional<double>> of_cases = results.values_of(measure.name);
    std::vector<std::optional<double>> values(num_rows);
    for (std::size_t i = 0; i < of_cases.size(); ++i) values.at(row_of[i]) = of_cases[i];
    if (std::optional<Sensitivity> s = sensitivity_of(design, 0, values))
      all.push_back({measure.name, variables, std::move(*s)});
  }
  return all;
}

std::optional<Sensitivity> sensitivity_of(const io::SweepDesign& design, std::uint32_t number, Values values) {
  using io::SweepDesignKind;
  switch (design.kind) {
    case SweepDesignKind::morris:
      return morris_effects(unit_rows_of(design, number), values);
    case SweepDesignKind::saltelli:
      return sobol_indices(design.variables.size(), values, design.seed);
    case SweepDesignKind::random:
    case SweepDesignKind::latin_hypercube:
    case SweepDesignKind::sobol: {
      std::vector<std::vector<double>> inputs;
      for_each_row(design, number, [&inputs](const std::vector<io::SweepValue>& row) {
        inputs.emplace_back();
        for (const io::SweepValue& v : row) inputs.back().push_back(v.number.value_or(0.0));
      });
      return regression(inputs, values);
    }
    default:
      return std::nullopt;
  }
}

}  // namespace bough::study
