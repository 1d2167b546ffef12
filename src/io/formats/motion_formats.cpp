/// The moving structure for bough itself, and states from which other runs can start.
#include "bough/io/motion_frames.hpp"
#include "bough/io/stored_states.hpp"
#include "result_format.hpp"

namespace bough::io {
namespace {

class MotionBin final : public ResultWriter {
 public:
  using ResultWriter::ResultWriter;
  void motion(const records::MotionFrame& frame, const records::MotionParts& parts) override {
    if (!writer_) writer_ = std::make_unique<MotionWriter>(folder() / "motion.bin", parts);
    writer_->frame(frame);
  }
  void checkpoint(records::Archive& archive, const records::HistoryHeader&) override {
    bool has_begun = writer_ != nullptr;
    archive(has_begun);
    if (!has_begun) return;
    if (archive.is_reading())
      writer_ = std::make_unique<MotionWriter>(folder() / "motion.bin", archive);
    else
      archive(*writer_);
  }
  std::vector<std::string> commit(const records::Summary&, const ListFile& list) override {
    if (!writer_) return {};
    return {commit_one(*writer_, list)};
  }

 private:
  std::unique_ptr<MotionWriter> writer_;
};

class StatesBin final : public ResultWriter {
 public:
  explicit StatesBin(const std::filesystem::path& folder) : ResultWriter(folder), writer_(folder / "states.bin") {}
  void state(const records::StoredState& state) override { writer_.state(state); }
  void checkpoint(records::Archive& archive, const records::HistoryHeader&) override { archive(writer_); }
  std::vector<std::string> commit(const records::Summary&, const ListFile& list) override {
    if (!writer_.has_begun()) return {};
    return {commit_one(writer_, list)};
  }

 private:
  StateWriter writer_;
};

}  // namespace

ResultFormat motion_bin() { return {"", {"motion.bin"}, make_writer<MotionBin>, ""}; }
ResultFormat states_bin() { return {"", {"states.bin"}, make_writer<StatesBin>, ""}; }

}  // namespace bough::io
