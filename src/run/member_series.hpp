#pragma once
#include <map>
#include <span>
#include <string>
#include <vector>

#include "bough/motion/quaternion.hpp"
#include "extrapolation.hpp"

namespace bough::run {

/// Values of all columns of a run at some times.
struct MemberSeries {
  std::vector<double> times;
  std::vector<std::vector<double>> values;
};

/// A column, or the columns of a rotation, which are compared as one.
struct ComparedColumns {
  enum class Kind : std::uint8_t { number, rotation_vector, quaternion };
  Kind kind = Kind::number;
  std::size_t first = 0, count = 1;
};
std::vector<ComparedColumns> compared_columns(const records::HistoryHeader& header);

/// Members of a family of runs, the finest first, at the times that all of them have.
class Family {
 public:
  /// Keeps references. run: its place among the members.
  Family(std::vector<const MemberSeries*> members, int run);

  int run() const { return run_; }
  std::size_t size() const { return members_.size(); }
  const std::vector<double>& times() const { return times_; }
  MemberDifferences differences(const ComparedColumns& columns) const;

 private:
  const std::vector<double>& row(std::size_t member, std::size_t time) const {
    return members_[member]->values[rows_[member][time]];
  }
  /// Finer minus coarser.
  std::vector<double> between(const ComparedColumns& columns, std::size_t finer, std::size_t coarser) const;

  std::vector<const MemberSeries*> members_;
  int run_;
  std::vector<double> times_;
  std::vector<std::vector<std::size_t>> rows_;  ///< by member: row at each of the times
};

/// Value of a rotation in its columns, turned by a rotation vector in its own axes: of the columns that mean this, those
/// nearest to the given ones.
void turn(const ComparedColumns& columns, const double* error, double* values);

/// Values of an error known at `times` (times x width) at another time: a cubic through the four nearest.
void interpolate(std::span<const double> times, const std::vector<double>& error, std::size_t width, double time,
                 double* found);

}  // namespace bough::run
