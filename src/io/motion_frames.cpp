#include "bough/io/motion_frames.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "bough/io/json_text.hpp"
#include "bough/io/json_value.hpp"
#include "bough/io/number_text.hpp"
#include "bough/motion/so3.hpp"

namespace bough::io {
namespace {

static_assert(std::endian::native == std::endian::little, "motion.bin holds numbers as they stand in memory");

constexpr const char* format_name = "bough motion 2";

using Mat3 = motion::Mat3<double>;
using Vec3 = motion::Vec3<double>;

// ---- header ----

template <class List, class Append>
void append_list(std::string& json, const List& list, const Append& append) {
  json += '[';
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (k > 0) json += ',';
    append(k);
  }
  json += ']';
}

template <class List>
void append_numbers(std::string& json, const List& list) {
  append_list(json, list, [&](std::size_t k) { append_number(json, static_cast<double>(list[k])); });
}

template <std::size_t N, class T>
std::vector<double> flat(const std::vector<std::array<T, N>>& points) {
  std::vector<double> values;
  for (const auto& p : points) values.insert(values.end(), p.begin(), p.end());
  return values;
}

template <class Part>
void append_names(std::string& json, const char* key, const std::vector<Part>& list) {
  json += std::string(",\"") + key + "\":";
  append_list(json, list, [&](std::size_t k) { json += json_string(list[k].name); });
}

std::size_t frame_bytes_of(const records::MotionFrame& f) {
  std::size_t floats = 9 * f.bodies.size() + 9 * f.links.size() + 6 * f.frames.size() + 9 * f.arrows.size();
  for (const records::Curve& c : f.curves) floats += 21 * c.points.size();
  return sizeof(double) + sizeof(float) * floats;
}

std::string header_of(const records::MotionParts& parts, const records::MotionFrame& f) {
  const auto number = [](auto n) { return std::to_string(n); };
  std::string json =
      std::string("{\"format\":\"") + format_name + "\",\"frame_bytes\":" + number(frame_bytes_of(f)) + ",\"curves\":";
  append_list(json, f.curves, [&](std::size_t k) {
    json += "{\"name\":" + json_string(f.curves[k].name) + ",\"points\":" + number(f.curves[k].points.size()) +
            ",\"outline\":" + number(k < parts.curves.size() ? parts.curves[k].outline : -1) + ",\"subdomains\":";
    append_numbers(json, k < parts.curves.size() ? parts.curves[k].subdomains : std::vector<int>());
    json += '}';
  });
  json += ",\"bodies\":";
  append_list(json, f.bodies, [&](std::size_t k) {
    json += "{\"name\":" + json_string(f.bodies[k].name) +
            ",\"attachments\":" + number(f.bodies[k].attachments.size()) +
            ",\"mesh\":" + number(k < parts.bodies.size() ? parts.bodies[k] : -1) + "}";
  });
  json += ",\"links\":";
  append_list(json, f.links, [&](std::size_t k) {
    json += "{\"name\":" + json_string(f.links[k].name) +
            ",\"kind\":" + json_string(k < parts.links.size() ? parts.links[k].kind : "") + "}";
  });
  append_names(json, "frames", f.frames);
  append_names(json, "arrows", f.arrows);
  json += ",\"outlines\":";
  append_list(json, parts.outlines, [&](std::size_t k) {
    const auto& loops = parts.outlines[k].loops;
    append_list(json, loops, [&](std::size_t l) { append_numbers(json, flat(loops[l])); });
  });
  json += ",\"meshes\":";
  append_list(json, parts.meshes, [&](std::size_t k) {
    json += "{\"points\":";
    append_numbers(json, flat(parts.meshes[k].points));
    json += ",\"triangles\":";
    append_numbers(json, flat(parts.meshes[k].triangles));
    json += '}';
  });
  json += '}';
  while ((json.size() + 1) % 8 != 0) json += ' ';
  return json + '\n';
}

// ---- numbers ----

template <class T>
void put(std::string& bytes, const double* values, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) {
    const T value = static_cast<T>(values[k]);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
}

void put_difference(std::string& bytes, const double* now, const double* start) {
  const double d[3] = {now[0] - start[0], now[1] - start[1], now[2] - start[2]};
  put<float>(bytes, d, 3);
}

Mat3 matrix_of(const double* axes) {
  Mat3 R;
  std::copy_n(axes, 9, R.m);
  return R;
}

void put_turn(std::string& bytes, const double* now, const double* start) {
  const Vec3 r = motion::log_so3(matrix_of(now) * lanes::transpose(matrix_of(start)));
  put<float>(bytes, r.v, 3);
}

std::string start_of(const records::MotionFrame& f) {
  std::string bytes;
  for (const records::Curve& curve : f.curves)
    for (const records::CurvePoint& p : curve.points) {
      put<double>(bytes, p.position, 3);
      put<double>(bytes, p.axes, 9);
    }
  for (const records::BodyPose& b : f.bodies) {
    put<double>(bytes, b.center, 3);
    put<double>(bytes, b.axes, 9);
    put<double>(bytes, b.position, 3);
    for (const auto& a : b.attachments) put<double>(bytes, a.data(), 3);
  }
  for (const records::Link& l : f.links) {
    put<double>(bytes, l.first, 3);
    put<double>(bytes, l.second, 3);
    put<double>(bytes, l.axes, 9);
  }
  for (const records::FramePose& p : f.frames) {
    put<double>(bytes, p.position, 3);
    put<double>(bytes, p.axes, 9);
  }
  for (const records::Arrow& a : f.arrows) put<double>(bytes, a.position, 3);
  return bytes;
}

std::string frame_of(const records::MotionFrame& f, const records::MotionFrame& start) {
  std::string bytes;
  bytes.reserve(frame_bytes_of(f));
  put<double>(bytes, &f.time, 1);
  for (std::size_t c = 0; c < f.curves.size(); ++c)
    for (std::size_t k = 0; k < f.curves[c].points.size(); ++k) {
      const records::CurvePoint &p = f.curves[c].points[k], &p0 = start.curves[c].points[k];
      put_difference(bytes, p.position, p0.position);
      put_turn(bytes, p.axes, p0.axes);
      put<float>(bytes, p.velocity, 3);
      put<float>(bytes, p.force, 6);
      put<float>(bytes, p.strain, 6);
    }
  for (std::size_t k = 0; k < f.bodies.size(); ++k) {
    put_difference(bytes, f.bodies[k].center, start.bodies[k].center);
    put_turn(bytes, f.bodies[k].axes, start.bodies[k].axes);
    put<float>(bytes, f.bodies[k].velocity, 3);
  }
  for (std::size_t k = 0; k < f.links.size(); ++k) {
    put_difference(bytes, f.links[k].first, start.links[k].first);
    put_difference(bytes, f.links[k].second, start.links[k].second);
    put_turn(bytes, f.links[k].axes, start.links[k].axes);
  }
  for (std::size_t k = 0; k < f.frames.size(); ++k) {
    put_difference(bytes, f.frames[k].position, start.frames[k].position);
    put_turn(bytes, f.frames[k].axes, start.frames[k].axes);
  }
  for (std::size_t k = 0; k < f.arrows.size(); ++k) {
    put_difference(bytes, f.arrows[k].position, start.arrows[k].position);
    put<float>(bytes, f.arrows[k].force, 3);
    put<float>(bytes, f.arrows[k].moment, 3);
  }
  return bytes;
}

// ---- reading ----

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw std::runtime_error(path.string() + ": " + what);
}

/// What the header says, in whose members a wrong type is told once, by `good`.
struct HeaderReader {
  const JsonValue& header;
  int most = 0;  ///< parts or points that a file of this size can hold
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
           v->number == static_cast<double>(static_cast<int>(v->number));
    return good ? static_cast<int>(v->number) : 0;
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

/// A frame with the names and sizes of all others, and what its parts are.
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
  for (const JsonValue* v : r.list(r.header, "arrows")) f.arrows.emplace_back().name = r.text(v);
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
  n.take<double>(&f.time, 1);
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
  }
  for (records::FramePose& p : f.frames) {
    n.moved(p.position);
    n.turned(p.axes);
  }
  for (records::Arrow& a : f.arrows) {
    n.moved(a.position);
    n.take<float>(a.force, 3);
    n.take<float>(a.moment, 3);
  }
}

}  // namespace

void MotionBytes::append(std::string& bytes, const records::MotionFrame& frame) {
  if (!start_) {
    start_ = std::make_unique<records::MotionFrame>(frame);
    bytes += header_of(parts_, frame);
    bytes += start_of(frame);
  }
  bytes += frame_of(frame, *start_);
}

void MotionWriter::frame(const records::MotionFrame& frame) {
  std::string bytes;
  bytes_.append(bytes, frame);
  file_.write(bytes);
}

Motion read_motion_file(const std::filesystem::path& path, std::size_t max_frames) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  std::string line;
  std::getline(file, line);
  std::vector<JsonFault> faults;
  const std::optional<JsonValue> header = parse_json(line, source_file, faults);
  const JsonValue* format = header && faults.empty() && header->is(JsonKind::object) ? header->find("format") : nullptr;
  if (format == nullptr || !(format->text == format_name))
    fail(path, std::string("not a file of the format '") + format_name + "'");
  const std::uintmax_t size = std::filesystem::file_size(path);
  HeaderReader reader{*header, static_cast<int>(std::min<std::uintmax_t>(size / 12, 1 << 30))};
  Motion motion;
  records::MotionFrame start = read_header(reader, motion.parts);
  if (!reader.good || header->find("frame_bytes") == nullptr ||
      header->find("frame_bytes")->number != static_cast<double>(frame_bytes_of(start)))
    fail(path, "the header does not say what the frames hold");

  const std::uintmax_t start_bytes = start_of(start).size();
  const std::uintmax_t begin = line.size() + 1 + start_bytes;
  const std::size_t frame_bytes = frame_bytes_of(start);
  motion.num_recorded = size > begin ? static_cast<std::size_t>((size - begin) / frame_bytes) : 0;
  if (motion.num_recorded == 0) fail(path, "holds no frame");
  std::string bytes(start_bytes, '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(start_bytes));
  read_start(bytes, start);
  const std::size_t wanted = std::min(motion.num_recorded, std::max<std::size_t>(max_frames, 2));
  bytes.resize(frame_bytes);
  for (std::size_t k = 0; k < wanted; ++k) {
    const std::size_t at = wanted < 2 ? 0 : k * (motion.num_recorded - 1) / (wanted - 1);
    file.seekg(static_cast<std::streamoff>(begin + at * frame_bytes));
    if (!file.read(bytes.data(), static_cast<std::streamsize>(frame_bytes))) fail(path, "cannot be read to its end");
    motion.frames.push_back(start);
    read_frame(bytes, motion.frames.back());
  }
  return motion;
}

}  // namespace bough::io
