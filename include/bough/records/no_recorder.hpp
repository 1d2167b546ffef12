#pragma once
#include "bough/records/run.hpp"

namespace bough::records {

/// For runs of which only the summary is wanted.
class NoRecorder final : public Recorder {
 public:
  void begin(const HistoryHeader&) override {}
  void row(const HistoryRow&) override {}
  void motion(const MotionFrame&) override {}
  void end(const Summary&) override {}
};

}  // namespace bough::records
