#pragma once
/// Errors of a run's results, measured by its twins: runs of the same scene with other steps or other meshes.
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "bough/records/run.hpp"

namespace bough::records {

/// What the twins of one kind tell about a value.
enum class ErrorState : std::uint8_t {
  not_measured,  ///< no twin of this kind has this value
  resolved,      ///< three members differ as errors of the theoretical order do
  unexamined,    ///< there are two members only: the error follows from the theoretical order, which was not examined
  round_off,     ///< members differ by no more than what tolerance and round-off leave open
  not_resolved,  ///< members do not differ as errors of the theoretical order do
};

/// The error of a value in time, or by the mesh, in the unit of the value. Of a column: over the times of the run.
struct ErrorPart {
  ErrorState state = ErrorState::not_measured;
  /// Magnitude of the error. Where it is not resolved: of the difference between the run and its twin, which is no bound.
  /// Where it is round-off: what tolerance and round-off leave open.
  double largest = 0.0, root_mean_square = 0.0;
  double spread = 0.0;     ///< largest difference between a member and the next finer one
  bool has_finer = false;  ///< a member is finer than the run
  double at_end = 0.0;     ///< limit minus value, at the end; 0 unless resolved or unexamined
  double when = 0.0;       ///< time of the largest [s], or load factor
  double theoretical_order = 0.0;
  /// log2 of the ratio of the differences of members, of their largest magnitudes and of their root mean squares; NaN:
  /// not measured.
  double order_of_largest = std::numeric_limits<double>::quiet_NaN();
  double order_of_root_mean_square = std::numeric_limits<double>::quiet_NaN();
  std::string cause;  ///< why it is not resolved or not measured, in words; empty: not known

  bool is_known() const {
    return state == ErrorState::resolved || state == ErrorState::unexamined || state == ErrorState::round_off;
  }
};

/// A column of the history, an expected figure or a measure, with its errors.
struct ErrorOf {
  std::string name;
  std::string unit;           ///< empty: a pure number, or not known
  double value = 0.0;         ///< of a column: at the end
  double extrapolated = 0.0;  ///< value plus known errors
  double range = 0.0;         ///< of a column: largest minus least value of its sensor's columns of this unit
  ErrorPart time, mesh;
};

/// A twin of the run.
struct TwinMember {
  bool is_of_mesh = false;
  double factor = 1.0;  ///< of the step size (of load steps: of their number), or of the numbers of elements
  RunStatus status = RunStatus::failed;
  std::string cause;     ///< of a failure
  double seconds = 0.0;  ///< wall [s]
};

struct MeasuredErrors {
  std::vector<TwinMember> members;
  std::vector<ErrorOf> columns, expected, measures;  ///< in the order of the summary
  /// Rows at the times of the history. Columns: of each column c of the history c.extrapolated, c.error_in_time and
  /// c.error_of_mesh, the last two limit minus value and not a number where they are not known.
  HistoryHeader header;
  std::vector<HistoryRow> rows;
  /// What holds for all columns, in words: no twin of a kind could run, from when on no digit is known.
  std::vector<std::string> remarks;
};

}  // namespace bough::records
