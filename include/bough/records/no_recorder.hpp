#pragma once
#include "bough/records/run.hpp"

namespace bough::records {

/// Discards rows and pictures of a run. Runs return their summary all the same.
class NoRecorder final : public Recorder {
 public:
  void begin(const HistoryHeader&) override {}
  void row(const HistoryRow&) override {}
  void motion(const MotionFrame&) override {}
  void end(const Summary&) override {}
};

}  // namespace bough::records
