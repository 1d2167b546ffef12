/// The moving structure for ParaView.
#include <stdexcept>
#include <system_error>

#include "bough/io/digest.hpp"
#include "bough/io/write_vtu.hpp"
#include "result_format.hpp"

namespace bough::io {
namespace {

namespace fs = std::filesystem;

std::string frame_name(std::size_t number) {
  std::string digits = std::to_string(number);
  if (digits.size() < 6) digits.insert(0, 6 - digits.size(), '0');
  return "motion/frame_" + digits + ".vtu";
}

class ParaView final : public ResultWriter {
 public:
  using ResultWriter::ResultWriter;
  void motion(const records::MotionFrame& frame, const records::MotionParts& parts) override {
    if (!frame.for_others) return;
    if (frames_.empty()) make_directory();
    const std::string name = frame_name(frames_.size());
    const std::string text = vtu_text(frame, parts);
    write_file(folder() / name, text, Durability::soon);
    frames_.push_back({frame.time, name});
    records_.push_back({name, text.size(), digest_of(text)});
  }
  void checkpoint(records::Archive& archive, const records::HistoryHeader&) override {
    if (!archive.is_reading())
      for (; synced_ < records_.size(); ++synced_) sync_file(folder() / records_[synced_].name);
    archive(frames_, records_);
    if (!archive.is_reading()) return;
    for (const FileRecord& frame : records_)
      if (digest_of_file(folder() / frame.name) != frame.hash)
        throw std::runtime_error((folder() / frame.name).string() + " is not as it was at the checkpoint");
    synced_ = records_.size();
  }
  std::vector<std::string> commit(const records::Summary&, const ListFile& list) override {
    if (frames_.empty()) return {};
    for (const FileRecord& frame : records_) list(frame);
    return {"motion", put("motion.pvd", pvd_text(frames_), list)};
  }

 private:
  void make_directory() const {
    std::error_code error;
    fs::create_directories(folder() / "motion", error);
    if (error)
      throw std::runtime_error("cannot make the directory " + (folder() / "motion").string() + ": " + error.message());
  }

  std::vector<PvdEntry> frames_;
  std::vector<FileRecord> records_;
  std::size_t synced_ = 0;  ///< frames that are on the disk
};

}  // namespace

ResultFormat paraview() { return {"", {"motion.pvd", "motion/frame_*"}, make_writer<ParaView>, ""}; }

}  // namespace bough::io
