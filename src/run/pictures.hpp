#pragma once
/// Selection of the states of a run that are drawn.
#include <optional>
#include <string>

#include "bough/plan/plan.hpp"
#include "bough/records/run.hpp"
#include "bough/scene/scene.hpp"

namespace bough::run {

/// Selects the pictures of a motion. If the scene gives a stride, it is followed. Otherwise a run has 101 pictures at
/// most, one per interval of equal time (or load), and fewer if motion.bin would exceed 120 MB or all files, states
/// included, 200 MB; and further ones wherever a part has turned by `turn_between` since the last one, as long as
/// motion.bin has room.
class Pictures {
 public:
  /// is_wanted: whether there are pictures at all.
  Pictures(const scene::Scene& scene, const plan::Plan& plan, bool is_wanted);

  bool is_wanted() const { return is_wanted_; }
  /// Whether the state at the end of step `row` (0: the start) is drawn; turn: TurnWatch::turn() since the last picture.
  bool is_due(long row, double time, double turn, bool is_last) const;
  /// Whether `set_size` has to be called before the next picture.
  bool is_first() const { return is_first_; }
  /// Estimates the size of pictures from the first one. If fewer are kept because of their size, returns a note with
  /// their number. num_states: nodes whose states are kept with every picture for other programs.
  [[nodiscard]] std::optional<std::string> set_size(const records::MotionFrame& frame,
                                                    const records::MotionParts& parts, std::size_t num_states = 0);
  /// Counts the picture of this time. Returns whether a VTU file for other programs is written of it, too.
  bool take(double time, bool is_last);
  void checkpoint(records::Archive& archive) {
    archive(stride_, most_intervals_, next_, others_every_, taken_, taken_by_turn_, most_by_turn_, is_first_);
  }

 private:
  bool is_passed(double time, int interval) const;
  bool has_room(double time) const;

  bool is_wanted_, follows_path_;
  int stride_;  ///< in steps; 0: not given
  double end_;  ///< [s], or load factor
  int most_intervals_ = 100, next_ = 1;
  int others_every_ = 1;  ///< a VTU file is written of every so many pictures
  int taken_ = 0;         ///< of those at equal intervals or by the stride
  int taken_by_turn_ = 0, most_by_turn_ = 0;
  bool is_first_ = true;
};

}  // namespace bough::run
