#include <algorithm>
#include <cstring>
#include <optional>
#include <stdexcept>

#include "bough/io/input_file.hpp"
#include "bough/io/json_value.hpp"
#include "bough/io/motion_frames.hpp"
#include "bough/io/number_text.hpp"
#include "bough/motion/so3.hpp"
#include "frame_blocks.hpp"
#include "motion_layout.hpp"

namespace bough::io {
namespace {

using Mat3 = motion::Mat3<double>;
using Vec3 = motion::Vec3<double>;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw std::runtime_error(path.string() + ": " + what);
}

/// Reads the header; `good` reports once if a member has the wrong type.
struct HeaderReader {
  const JsonValue& header;
  int most = 0;  ///< largest number of parts or points in a file of this size
  bool good = true;

  const std::vector<const JsonValue*> list(const JsonValue& of, std::string_view key) {
    std::vector<const JsonValue*> found;
    const JsonValue* v = of.find(key);
    good = good && v != nullptr && v->is(JsonKind::array);
    if (good)
      for (const JsonValue& item : v->items) found.push_back(&item);
    return found;
  }
  std::string text(const JsonValue* v) {
    good = good && v != nullptr && v->is(JsonKind::string);
    return good ? v->text.str() : std::string();
  }
  /// A whole number in [low, high].
  int count(const JsonValue* v, int low, int high) {
    good = good && v != nullptr && v->is(JsonKind::number) && v->number >= low && v->number <= high &&
           v->number == static_cast<double>(whole_number<int>(v->number));
    return good ? whole_number<int>(v->number) : 0;
  }
  template <std::size_t N, class T>
  std::vector<std::array<T, N>> tuples(const JsonValue& of) {
    good = good && of.is(JsonKind::array) && of.items.size() % N == 0;
    std::vector<std::array<T, N>> all;
    for (std::size_t k = 0; good && k + N <= of.items.size(); k += N)
      for (std::size_t i = 0; i < N; ++i) {
        good = good && of.items[k + i].is(JsonKind::number);
        if (i == 0) all.emplace_back();
        all.back()[i] = static_cast<T>(of.items[k + i].number);
      }
    return all;
  }
};

void read_shapes(HeaderReader& r, records::MotionParts& parts) {
  for (const JsonValue* outline : r.list(r.header, "outlines")) {
    r.good = r.good && outline->is(JsonKind::array);
    if (!r.good) return;
    parts.outlines.emplace_back();
    for (const JsonValue& loop : outline->items) parts.outlines.back().loops.push_back(r.tuples<2, double>(loop));
  }
  for (const JsonValue* mesh : r.list(r.header, "meshes")) {
    const JsonValue *points = mesh->find("points"), *triangles = mesh->find("triangles");
    r.good = r.good && points != nullptr && triangles != nullptr;
    if (!r.good) return;
    parts.meshes.push_back({r.tuples<3, double>(*points), r.tuples<3, int>(*triangles)});
    const int num_points = static_cast<int>(parts.meshes.back().points.size());
    for (const auto& t : parts.meshes.back().triangles)
      for (const int corner : t) r.good = r.good && corner >= 0 && corner < num_points;
  }
}

/// A frame with the names and sizes of all others, and the properties of its parts.
records::MotionFrame read_header(HeaderReader& r, records::MotionParts& parts) {
  records::MotionFrame f;
  read_shapes(r, parts);
  for (const JsonValue* v : r.list(r.header, "curves")) {
    records::Curve& curve = f.curves.emplace_back();
    curve.name = r.text(v->find("name"));
    curve.points.resize(static_cast<std::size_t>(r.count(v->find("points"), 0, r.most)));
    records::MotionParts::Curve& part = parts.curves.emplace_back();
    part.outline = r.count(v->find("outline"), -1, static_cast<int>(parts.outlines.size()) - 1);
    for (const JsonValue* s : r.list(*v, "subdomains")) part.subdomains.push_back(r.count(s, -1, 1 << 30));
  }
  for (const JsonValue* v : r.list(r.header, "bodies")) {
    records::BodyPose& body = f.bodies.emplace_back();
    body.name = r.text(v->find("name"));
    body.attachments.resize(static_cast<std::size_t>(r.count(v->find("attachments"), 0, r.most)));
    parts.bodies.push_back(r.count(v->find("mesh"), -1, static_cast<int>(parts.meshes.size()) - 1));
  }
  for (const JsonValue* v : r.list(r.header, "links")) {
    f.links.emplace_back().name = r.text(v->find("name"));
    parts.links.push_back({r.text(v->find("kind"))});
  }
  for (const JsonValue* v : r.list(r.header, "frames")) f.frames.emplace_back().name = r.text(v);
  for (const JsonValue* v : r.list(r.header, "arrows")) {
    records::Arrow& arrow = f.arrows.emplace_back();
    arrow.name = r.text(v->find("name"));
    arrow.is_per_length = r.text(v->find("kind")) == "line load";
  }
  if (r.header.find("signals") != nullptr)
    for (const JsonValue* v : r.list(r.header, "signals")) f.signals.push_back({r.text(v)});
  if (r.header.find("signal_units") != nullptr)
    for (const JsonValue* v : r.list(r.header, "signal_units")) parts.signal_units.push_back(r.text(v));
  return f;
}

/// Takes numbers one after the other from bytes whose length was checked.
class Numbers {
 public:
  explicit Numbers(const std::string& bytes) : at_(bytes.data()) {}
  template <class T>
  void take(double* to, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k, at_ += sizeof(T)) {
      T value;
      std::memcpy(&value, at_, sizeof value);
      to[k] = static_cast<double>(value);
    }
  }
  Vec3 vector() {
    Vec3 v;
    take<float>(v.v, 3);
    return v;
  }
  void moved(double* x) {  ///< x holds the start
    const Vec3 d = vector();
    for (int k = 0; k < 3; ++k) x[k] += d[k];
  }
  Mat3 turned(double* axes) {
    const Mat3 Q = motion::exp_so3(vector());
    const Mat3 R = Q * matrix_of(axes);
    std::copy_n(R.m, 9, axes);
    return Q;
  }

 private:
  const char* at_;
};

void read_start(const std::string& bytes, records::MotionFrame& f) {
  Numbers n(bytes);
  for (records::Curve& curve : f.curves)
    for (records::CurvePoint& p : curve.points) {
      n.take<double>(p.position, 3);
      n.take<double>(p.axes, 9);
    }
  for (records::BodyPose& b : f.bodies) {
    n.take<double>(b.center, 3);
    n.take<double>(b.axes, 9);
    n.take<double>(b.position, 3);
    for (auto& a : b.attachments) n.take<double>(a.data(), 3);
  }
  for (records::Link& l : f.links) {
    n.take<double>(l.first, 3);
    n.take<double>(l.second, 3);
    n.take<double>(l.axes, 9);
  }
  for (records::FramePose& p : f.frames) {
    n.take<double>(p.position, 3);
    n.take<double>(p.axes, 9);
  }
  for (records::Arrow& a : f.arrows) n.take<double>(a.position, 3);
}

void read_frame(const std::string& bytes, records::MotionFrame& f) {
  Numbers n(bytes);
  for (records::Curve& curve : f.curves)
    for (records::CurvePoint& p : curve.points) {
      n.moved(p.position);
      n.turned(p.axes);
      n.take<float>(p.velocity, 3);
      n.take<float>(p.force, 6);
      n.take<float>(p.strain, 6);
    }
  for (records::BodyPose& b : f.bodies) {
    Vec3 center_before;
    std::copy_n(b.center, 3, center_before.v);
    n.moved(b.center);
    const Mat3 Q = n.turned(b.axes);
    const auto carried = [&](double* x) {
      Vec3 arm;
      for (int k = 0; k < 3; ++k) arm[k] = x[k] - center_before[k];
      arm = Q * arm;
      for (int k = 0; k < 3; ++k) x[k] = b.center[k] + arm[k];
    };
    carried(b.position);
    for (auto& a : b.attachments) carried(a.data());
    n.take<float>(b.velocity, 3);
  }
  for (records::Link& l : f.links) {
    n.moved(l.first);
    n.moved(l.second);
    n.turned(l.axes);
    n.take<float>(l.first_velocity, 3);
    n.take<float>(l.second_velocity, 3);
  }
  for (records::FramePose& p : f.frames) {
    n.moved(p.position);
    n.turned(p.axes);
    n.take<float>(p.velocity, 3);
  }
  for (records::Arrow& a : f.arrows) {
    n.moved(a.position);
    n.take<float>(a.velocity, 3);
    n.take<float>(a.force, 3);
    n.take<float>(a.moment, 3);
  }
  for (records::SignalValue& s : f.signals) n.take<float>(&s.value, 1);
}

struct Block {
  FrameHead head;
  std::uint64_t begin = 0;  ///< of its packed bytes in the file
};

/// All complete frames; a frame that a crash cut off at the end is ignored.
std::vector<Block> blocks_of(const InputFile& file, std::uint64_t begin) {
  std::vector<Block> blocks;
  std::string head(frame_head_bytes, '\0');
  while (file.read(begin, head.data(), head.size()) == head.size()) {
    const Block block{frame_head(head), begin + frame_head_bytes};
    if (block.head.size > file.size() - std::min(block.begin, file.size())) break;
    blocks.push_back(block);
    begin = block.begin + block.head.size;
  }
  return blocks;
}

/// Which frames are read: all, if there are few or if parts turn between them, as far as memory allows that; otherwise
/// evenly chosen ones.
std::vector<std::size_t> chosen_of(const std::vector<Block>& blocks, std::size_t max_frames, std::size_t start_bytes) {
  constexpr double most = 3001.0, most_bytes = 400e6;   // of frames, and of their numbers in memory
  constexpr double turn = 0.6 * records::largest_turn;  // between two frames
  double all = 0.0;
  for (const Block& block : blocks) all += block.head.turn;
  const double turning =
      std::min({most, most_bytes / (2.0 * static_cast<double>(start_bytes) + 1.0), 1.0 + all / turn});
  const std::size_t wanted =
      std::min(blocks.size(), std::max({max_frames, std::size_t{2}, static_cast<std::size_t>(turning)}));
  std::vector<std::size_t> chosen(wanted);
  for (std::size_t k = 1; k < wanted; ++k) chosen[k] = k * (blocks.size() - 1) / (wanted - 1);
  return chosen;
}

}  // namespace

Motion read_motion_file(const std::filesystem::path& path, std::size_t max_frames) {
  InputFile file(path);
  std::string line;
  (void)file.next_line(line);
  std::vector<JsonFault> faults;
  const std::optional<JsonValue> header = parse_json(line, source_file, faults);
  const JsonValue* format = header && faults.empty() && header->is(JsonKind::object) ? header->find("format") : nullptr;
  if (format == nullptr || !(format->text == motion_format))
    fail(path, std::string("not a file of the format '") + motion_format + "'");
  HeaderReader reader{*header, static_cast<int>(std::min<std::uint64_t>(file.size() / 12, 1 << 30))};
  Motion motion;
  records::MotionFrame start = read_header(reader, motion.parts);
  const std::size_t num_floats = frame_floats_of(start);
  if (!reader.good || header->find("frame_floats") == nullptr ||
      header->find("frame_floats")->number != static_cast<double>(num_floats))
    fail(path, "the header does not say what the frames hold");

  std::string bytes(start_of(start).size(), '\0');
  if (file.read(line.size() + 1, bytes.data(), bytes.size()) < bytes.size()) fail(path, "holds no frame");
  read_start(bytes, start);
  const std::vector<Block> blocks = blocks_of(file, line.size() + 1 + bytes.size());
  motion.num_recorded = blocks.size();
  if (blocks.empty()) fail(path, "holds no frame");
  double turned = 0.0;  // from the frame before those that are left out
  std::size_t next = 0;
  for (const std::size_t k : chosen_of(blocks, max_frames, bytes.size())) {
    const Block& block = blocks[k];
    for (turned = 0.0; next <= k; ++next) turned += blocks[next].head.turn;
    bytes.resize(static_cast<std::size_t>(block.head.size));
    if (file.read(block.begin, bytes.data(), bytes.size()) < bytes.size()) fail(path, "cannot be read to its end");
    const std::optional<std::string> floats = unpacked_frame(bytes, sizeof(float) * num_floats);
    if (!floats) fail(path, "a frame cannot be unpacked");
    motion.frames.push_back(start);
    motion.frames.back().time = block.head.time;
    motion.frames.back().turn = turned;
    read_frame(*floats, motion.frames.back());
  }
  return motion;
}

}  // namespace bough::io
