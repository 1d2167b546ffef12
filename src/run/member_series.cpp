#include "member_series.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace bough::run {

namespace {

using Quaternion = motion::Quaternion<double>;
using Kind = ComparedColumns::Kind;

constexpr double same_time = 1e-9;  ///< relative to the last one

Quaternion quaternion_in(const ComparedColumns& columns, const double* v) {
  if (columns.kind == Kind::quaternion) return motion::normalise(Quaternion{v[0], {{v[1], v[2], v[3]}}});
  return motion::exp_quaternion(motion::Vec3<double>{{v[0], v[1], v[2]}});
}

/// Rotation vector of a unit quaternion, at most pi long [rad].
motion::Vec3<double> vector_of(const Quaternion& q) {
  return motion::log_quaternion(q.w < 0.0 ? Quaternion{-q.w, -q.v} : q);
}

}  // namespace

std::vector<ComparedColumns> compared_columns(const records::HistoryHeader& header) {
  std::vector<ComparedColumns> list;
  const std::size_t count = header.columns.size();
  for (std::size_t c = 0; c < count;) {
    ComparedColumns columns{Kind::number, c, 1};
    const std::string quantity = c < header.about.size() ? header.about[c].quantity : std::string();
    if (quantity == "rotation" && c + 3 <= count) columns = {Kind::rotation_vector, c, 3};
    if (quantity == "quaternion" && c + 4 <= count) columns = {Kind::quaternion, c, 4};
    list.push_back(columns);
    c += columns.count;
  }
  return list;
}

Family::Family(std::vector<const MemberSeries*> members, int run)
    : members_(std::move(members)), run_(run), rows_(members_.size()) {
  std::vector<std::size_t> next(members_.size(), 0);
  const MemberSeries& first = *members_.front();
  if (first.times.empty()) return;
  const double near = same_time * std::max(std::abs(first.times.back()), std::abs(first.times.front()));
  for (std::size_t k = 0; k < first.times.size(); ++k) {
    bool has_all = true;
    for (std::size_t m = 0; m < members_.size() && has_all; ++m) {
      const std::vector<double>& times = members_[m]->times;
      while (next[m] < times.size() && times[next[m]] < first.times[k] - near) ++next[m];
      has_all = next[m] < times.size() && times[next[m]] <= first.times[k] + near;
    }
    if (!has_all) continue;
    times_.push_back(first.times[k]);
    for (std::size_t m = 0; m < members_.size(); ++m) rows_[m].push_back(next[m]);
  }
}

std::vector<double> Family::between(const ComparedColumns& columns, std::size_t finer, std::size_t coarser) const {
  std::vector<double> difference;
  for (std::size_t k = 0; k < times_.size(); ++k) {
    const double* const a = row(finer, k).data() + columns.first;
    const double* const b = row(coarser, k).data() + columns.first;
    if (columns.kind == Kind::number) {
      difference.push_back(*a - *b);
      continue;
    }
    const auto d = vector_of(motion::multiply(motion::conjugate(quaternion_in(columns, b)), quaternion_in(columns, a)));
    for (int i = 0; i < 3; ++i) difference.push_back(d[i]);
  }
  return difference;
}

MemberDifferences Family::differences(const ComparedColumns& columns) const {
  MemberDifferences d;
  d.width = columns.kind == Kind::number ? 1 : 3;
  if (size() > 1) d.fine = between(columns, 0, 1);
  if (size() > 2) d.coarse = between(columns, 1, 2);
  return d;
}

void turn(const ComparedColumns& columns, const double* error, double* values) {
  const Quaternion by = motion::exp_quaternion(motion::Vec3<double>{{error[0], error[1], error[2]}});
  const Quaternion q = motion::multiply(quaternion_in(columns, values), by);
  if (columns.kind == Kind::quaternion) {
    const double sign = q.w * values[0] + q.v[0] * values[1] + q.v[1] * values[2] + q.v[2] * values[3] < 0.0 ? -1 : 1;
    values[0] = sign * q.w;
    for (int i = 0; i < 3; ++i) values[1 + i] = sign * q.v[i];
    return;
  }
  const motion::Vec3<double> psi = vector_of(q);
  const double angle = std::hypot(psi[0], psi[1], psi[2]);
  const double along = angle > 0.0 ? (psi[0] * values[0] + psi[1] * values[1] + psi[2] * values[2]) / angle : 0.0;
  const double turns = std::round((along - angle) / (2.0 * std::numbers::pi));
  const double factor = angle > 0.0 ? 1.0 + turns * 2.0 * std::numbers::pi / angle : 1.0;
  for (int i = 0; i < 3; ++i) values[i] = factor * psi[i];
}

void interpolate(std::span<const double> times, const std::vector<double>& error, std::size_t width, double time,
                 double* found) {
  const std::size_t count = std::min<std::size_t>(4, times.size());
  const auto after = static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), time) - times.begin());
  const std::size_t begin = std::min(after < 2 ? 0 : after - 2, times.size() - count);
  for (std::size_t i = 0; i < width; ++i) found[i] = 0.0;
  for (std::size_t k = begin; k < begin + count; ++k) {
    double weight = 1.0;
    for (std::size_t j = begin; j < begin + count; ++j)
      if (j != k) weight *= (time - times[j]) / (times[k] - times[j]);
    for (std::size_t i = 0; i < width; ++i) found[i] += weight * error[k * width + i];
  }
}

}  // namespace bough::run
