#include "bough/io/motion_frames.hpp"

#include <algorithm>
#include <fstream>
#include <span>
#include <stdexcept>

#include "bough/io/json_text.hpp"
#include "bough/io/json_value.hpp"
#include "bough/io/number_text.hpp"

namespace bough::io {
namespace {

constexpr const char* format_name = "bough motion 1";
constexpr int digits = 9;

template <class Part>
void append_names(std::string& line, const char* key, const std::vector<Part>& parts) {
  line += ",\"";
  line += key;
  line += "\":[";
  for (std::size_t k = 0; k < parts.size(); ++k) {
    if (k > 0) line += ',';
    line += json_string(parts[k].name);
  }
  line += ']';
}

void append_values(std::string& line, std::span<const double> values) {
  for (const double value : values) {
    if (line.back() != '[') line += ',';
    append_rounded(line, value, digits);
  }
}

/// `,"key":[[...],[...]]`, the numbers of part k appended by `append_part`.
template <class Part, class AppendPart>
void append_parts(std::string& line, const char* key, const std::vector<Part>& parts, const AppendPart& append_part) {
  line += ",\"";
  line += key;
  line += "\":[";
  for (std::size_t k = 0; k < parts.size(); ++k) {
    line += k > 0 ? ",[" : "[";
    append_part(parts[k]);
    line += ']';
  }
  line += ']';
}

[[noreturn]] void fail_at(const std::filesystem::path& path, std::size_t line, const std::string& what) {
  throw std::runtime_error(path.string() + ":" + std::to_string(line) + ": " + what);
}

struct Names {
  std::vector<std::string> curves, bodies, links;
};

std::vector<std::string> read_names(const JsonValue& header, std::string_view key, bool& good) {
  std::vector<std::string> names;
  const JsonValue* list = header.find(key);
  good = good && list != nullptr && list->is(JsonKind::array);
  if (!good) return names;
  for (const JsonValue& item : list->items) {
    good = good && item.is(JsonKind::string);
    names.push_back(item.text.str());
  }
  return names;
}

JsonValue parse_line(const std::filesystem::path& path, std::size_t number, const std::string& line) {
  std::vector<JsonFault> faults;
  std::optional<JsonValue> value = parse_json(line, source_file, faults);
  if (!value || !faults.empty() || !value->is(JsonKind::object)) fail_at(path, number, "not a JSON object");
  return std::move(*value);
}

/// Numbers of part k of the list `key`; their count must be `count`, or any multiple of 3 where count is 0.
std::vector<double> read_part(const JsonValue& frame, std::string_view key, std::size_t k, std::size_t count,
                              bool& good) {
  std::vector<double> values;
  const JsonValue* list = frame.find(key);
  good = good && list != nullptr && list->is(JsonKind::array) && k < list->items.size() &&
         list->items[k].is(JsonKind::array);
  if (!good) return values;
  for (const JsonValue& item : list->items[k].items) {
    good = good && item.is(JsonKind::number);
    values.push_back(item.number);
  }
  good = good && (count == 0 ? values.size() % 3 == 0 : values.size() == count);
  return values;
}

results::MotionFrame read_frame(const JsonValue& value, const Names& names, bool& good) {
  results::MotionFrame frame;
  const JsonValue* time = value.find("t");
  good = good && time != nullptr && time->is(JsonKind::number);
  if (good) frame.time = time->number;
  for (std::size_t k = 0; good && k < names.curves.size(); ++k) {
    const std::vector<double> x = read_part(value, "c", k, 0, good);
    results::Curve& curve = frame.curves.emplace_back();
    curve.name = names.curves[k];
    for (std::size_t p = 0; good && p + 2 < x.size(); p += 3) {
      results::CurvePoint point{};
      std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(p), 3, point.position);
      curve.points.push_back(point);
    }
  }
  for (std::size_t k = 0; good && k < names.bodies.size(); ++k) {
    const std::vector<double> x = read_part(value, "b", k, 0, good);
    good = good && x.size() >= 15;
    if (!good) break;
    results::BodyPose& body = frame.bodies.emplace_back();
    body.name = names.bodies[k];
    std::copy_n(x.begin(), 3, body.position);
    std::copy_n(x.begin() + 3, 9, body.axes);
    std::copy_n(x.begin() + 12, 3, body.center);
    for (std::size_t p = 15; p < x.size(); p += 3) body.attachments.push_back({x[p], x[p + 1], x[p + 2]});
  }
  for (std::size_t k = 0; good && k < names.links.size(); ++k) {
    const std::vector<double> x = read_part(value, "l", k, 6, good);
    if (!good) break;
    results::Link& link = frame.links.emplace_back();
    link.name = names.links[k];
    std::copy_n(x.begin(), 3, link.first);
    std::copy_n(x.begin() + 3, 3, link.second);
  }
  return frame;
}

Names read_header(const std::filesystem::path& path, const std::string& line) {
  const JsonValue header = parse_line(path, 1, line);
  const JsonValue* format = header.find("format");
  if (format == nullptr || !(format->text == format_name))
    fail_at(path, 1, std::string("not a file of the format '") + format_name + "'");
  bool good = true;
  Names names{read_names(header, "curves", good), read_names(header, "bodies", good),
              read_names(header, "links", good)};
  if (!good) fail_at(path, 1, "the header must list the names of curves, bodies and links");
  return names;
}

}  // namespace

void MotionLines::append(std::string& text, const results::MotionFrame& frame) {
  if (!has_header_) {
    text += std::string("{\"format\":\"") + format_name + '"';
    append_names(text, "curves", frame.curves);
    append_names(text, "bodies", frame.bodies);
    append_names(text, "links", frame.links);
    text += "}\n";
    has_header_ = true;
  }
  text += "{\"t\":";
  append_number(text, frame.time);
  append_parts(text, "c", frame.curves, [&text](const results::Curve& curve) {
    for (const results::CurvePoint& point : curve.points) append_values(text, point.position);
  });
  append_parts(text, "b", frame.bodies, [&text](const results::BodyPose& body) {
    append_values(text, body.position);
    append_values(text, body.axes);
    append_values(text, body.center);
    for (const std::array<double, 3>& point : body.attachments) append_values(text, point);
  });
  append_parts(text, "l", frame.links, [&text](const results::Link& link) {
    append_values(text, link.first);
    append_values(text, link.second);
  });
  text += "}\n";
}

void MotionLinesWriter::frame(const results::MotionFrame& frame) {
  line_.clear();
  lines_.append(line_, frame);
  file_.write(line_);
}

std::vector<results::MotionFrame> read_motion_lines(const std::filesystem::path& path, std::size_t max_frames) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  std::string line;
  std::size_t num_lines = 0;
  while (std::getline(file, line)) ++num_lines;
  if (num_lines < 2) throw std::runtime_error(path.string() + ": holds no frame");
  file.clear();
  file.seekg(0);
  std::getline(file, line);
  const Names names = read_header(path, line);

  const std::size_t num_frames = num_lines - 1;
  const std::size_t wanted = std::min(num_frames, std::max<std::size_t>(max_frames, 2));
  std::vector<results::MotionFrame> frames;
  frames.reserve(wanted);
  for (std::size_t k = 0; k < num_frames && std::getline(file, line); ++k) {
    const std::size_t next = wanted < 2 ? 0 : frames.size() * (num_frames - 1) / (wanted - 1);
    if (frames.size() == wanted || k != next) continue;
    bool good = true;
    frames.push_back(read_frame(parse_line(path, k + 2, line), names, good));
    if (!good) fail_at(path, k + 2, "not a frame of the parts that the header names");
  }
  return frames;
}

}  // namespace bough::io
