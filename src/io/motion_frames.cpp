#include "bough/io/motion_frames.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <stdexcept>

#include "bough/io/json_text.hpp"
#include "bough/io/number_text.hpp"
#include "bough/motion/so3.hpp"
#include "frame_blocks.hpp"
#include "motion_layout.hpp"

namespace bough::io {
namespace {

static_assert(std::endian::native == std::endian::little, "motion.bin holds numbers as they stand in memory");

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

std::string header_of(const records::MotionParts& parts, const records::MotionFrame& f) {
  const auto number = [](auto n) { return std::to_string(n); };
  std::string json = std::string("{\"format\":\"") + motion_format +
                     "\",\"frame_floats\":" + number(frame_floats_of(f)) + ",\"curves\":";
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
  json += ",\"arrows\":";
  append_list(json, f.arrows, [&](std::size_t k) {
    json += "{\"name\":" + json_string(f.arrows[k].name) + ",\"kind\":\"" +
            (f.arrows[k].is_per_length ? "line load" : "load") + "\"}";
  });
  if (!f.signals.empty()) {
    append_names(json, "signals", f.signals);
    json += ",\"signal_units\":";
    append_list(json, f.signals, [&](std::size_t k) {
      json += json_string(k < parts.signal_units.size() ? parts.signal_units[k] : "");
    });
  }
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

void put_turn(std::string& bytes, const double* now, const double* start) {
  const Vec3 r = motion::log_so3(matrix_of(now) * lanes::transpose(matrix_of(start)));
  put<float>(bytes, r.v, 3);
}

std::string frame_of(const records::MotionFrame& f, const records::MotionFrame& start) {
  std::string bytes;
  bytes.reserve(sizeof(float) * frame_floats_of(f));
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
    put<float>(bytes, f.links[k].first_velocity, 3);
    put<float>(bytes, f.links[k].second_velocity, 3);
  }
  for (std::size_t k = 0; k < f.frames.size(); ++k) {
    put_difference(bytes, f.frames[k].position, start.frames[k].position);
    put_turn(bytes, f.frames[k].axes, start.frames[k].axes);
    put<float>(bytes, f.frames[k].velocity, 3);
  }
  for (std::size_t k = 0; k < f.arrows.size(); ++k) {
    put_difference(bytes, f.arrows[k].position, start.arrows[k].position);
    put<float>(bytes, f.arrows[k].velocity, 3);
    put<float>(bytes, f.arrows[k].force, 3);
    put<float>(bytes, f.arrows[k].moment, 3);
  }
  for (const records::SignalValue& s : f.signals) put<float>(bytes, &s.value, 1);
  return packed_frame(f.time, f.turn, bytes);
}

}  // namespace

std::size_t frame_floats_of(const records::MotionFrame& f) {
  std::size_t floats =
      9 * f.bodies.size() + 15 * f.links.size() + 9 * f.frames.size() + 12 * f.arrows.size() + f.signals.size();
  for (const records::Curve& c : f.curves) floats += 21 * c.points.size();
  return floats;
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

void MotionBytes::append(std::string& bytes, const records::MotionFrame& frame) {
  if (!start_) {
    start_ = frame;
    bytes += header_of(parts_, frame);
    bytes += start_of(frame);
  }
  bytes += frame_of(frame, *start_);
}

void MotionWriter::frame(const records::MotionFrame& frame) {
  std::string bytes;
  bytes_.append(bytes, frame);
  file_->write(bytes);
}

}  // namespace bough::io
