#include "bough/io/read_frames.hpp"

#include <algorithm>
#include <cmath>

#include "bough/io/number_text.hpp"
#include "bough/io/schema_rule.hpp"
#include "document_report.hpp"
#include "kinematics_rules.hpp"
#include "read_values.hpp"
#include "schema_parts.hpp"

namespace bough::io {
namespace {

RuleTable make_frame_rules() {
  RuleTable t;
  add_part_rules(t);
  add_law_rules(t);
  const RuleRef three_laws = named_rule("three_laws");
  t.named["moving_frame"] = made(object_of(
      "A frame that moves in the one before it, the first in the inertial frame.",
      {need("name", name_rule(""), "Its name."),
       may("position", three_laws, "Of the origin in the axes of the frame before [m].", "[0, 0, 0]"),
       may("rotation", named_rule("rotation"), "Of the axes where all turns are zero. Default: none."),
       may("turns", array_rule("", named_rule("turn")), "Rotations that follow, one after the other.", "[]")}));
  const RuleRef frame_name = text_rule("");
  t.root = made(object_of(
      "A chain of moving frames and a point, for bough kinematics razi. SI units and radians throughout. A "
      "\"comment\" string is allowed in every object.",
      {may("$schema", text_rule(""), "Address of this schema, for editors; not read."),
       need("schema_version", integer_rule("", 1, 1), "Version of the format: 1."),
       may("title", text_rule(""), "One line.", "\"\""),
       need("frames", array_rule("", named_rule("moving_frame"), 1, 1000), "The frames, each in the one before."),
       need("point",
            made(object_of("A point.", {need("position", three_laws, "In the axes of its frame [m]."),
                                        may("frame", frame_name, "Its frame, or \"ground\". Default: the last.")})),
            "The point that is watched."),
       may("from", frame_name, "Frame of the observer: a name, or \"ground\".", "\"ground\""),
       may("in", frame_name, "Frame in whose axes vectors are given: a name, or \"ground\".", "\"ground\""),
       need("time",
            made(object_of("Times at equal distances, both ends among them.",
                           {may("start", number_rule(""), "First [s].", "0"), need("end", number_rule(""), "Last [s]."),
                            may("points", integer_rule("", 2, 1e6), "How many.", "361")})),
            "When.")}));
  return t;
}

}  // namespace

const RuleTable& frame_rules() {
  static const RuleTable table = make_frame_rules();
  return table;
}

namespace {

/// Converts a checked document to a study, without its faulty parts.
class FrameConverter : private ValueConverter {
 public:
  using ValueConverter::faults;
  using ValueConverter::warnings;
  scene::FrameStudy study;

  void convert(const JsonValue& root) {
    if (const Value* title = sound(root, "title")) study.title = title->text;
    read_frames(root.find("frames"));
    if (const Value* point = sound(root, "point")) {
      laws_of(*point->find("position"), "/point/position", study.point);
      study.point_frame = static_cast<int>(names_.size()) - 1;
      if (const Value* frame = point->find("frame")) study.point_frame = index_of(*frame, "/point/frame");
    }
    if (const Value* from = sound(root, "from")) study.from = index_of(*from, "/from");
    if (const Value* in = sound(root, "in")) study.in = index_of(*in, "/in");
    if (const Value* time = sound(root, "time")) {
      study.start_time = time->find("start")->number;
      study.end_time = time->find("end")->number;
      study.num_points = whole_number<int>(time->find("points")->number);
      if (study.end_time > study.start_time)
        check_laws();
      else
        fault("/time/end", "the end is after the start");
    }
  }

 private:
  static const Value* sound(const Value& object, const char* key) {
    const Value* v = object.find(key);
    return v != nullptr && v->sound ? v : nullptr;
  }

  laws::Law placed_law(const Value& v, const std::string& at, bool is_rate = false) {
    const laws::Law given = law(v, at);
    placed_laws_.emplace_back(at, is_rate ? given.integral(0.0) : given);
    return placed_laws_.back().second;
  }

  void laws_of(const Value& three, const std::string& at, laws::Law (&out)[3]) {
    for (std::size_t k = 0; k < 3; ++k) out[k] = placed_law(three.items[k], at + "/" + std::to_string(k));
  }

  /// A prescribed motion needs value, rate and acceleration at every time of the study.
  void check_laws() {
    for (const auto& [at, checked] : placed_laws_)
      for (int k = 0; k < study.num_points; ++k) {
        const double t = scene::time_of(study, k);
        const std::optional<std::string> what = laws::non_finite(checked.at(t));
        if (!what) continue;
        fault(at, "the law is not finite at t = " + rounded_text(t, 9) + " s: " + *what);
        break;
      }
  }

  /// Names of faulty frames are known, so that references to them are not reported as well.
  void read_frames(const Value* list) {
    if (list == nullptr || !list->is(JsonKind::array)) {
      all_named_ = false;
      return;
    }
    for (std::size_t i = 0; i < list->items.size(); ++i) {
      const Value& v = list->items[i];
      const std::string at = "/frames/" + std::to_string(i);
      const Value* name = v.is(JsonKind::object) ? v.find("name") : nullptr;
      if (name == nullptr || !name->sound || !name->is(JsonKind::string)) {
        all_named_ = false;
        names_.emplace_back();
      } else {
        if (std::find(names_.begin(), names_.end(), name->text) != names_.end())
          fault(at + "/name", "this name is taken already", "names are used once");
        names_.push_back(name->text);
      }
      if (v.sound) study.frames.push_back(frame(v, at));
    }
  }

  scene::MovingFrame frame(const Value& v, const std::string& at) {
    scene::MovingFrame f;
    f.name = v.find("name")->text;
    laws_of(*v.find("position"), at + "/position", f.position);
    if (const Value* r = v.find("rotation")) f.rotation = rotation(*r, at + "/rotation");
    const Value& turns = *v.find("turns");
    for (std::size_t k = 0; k < turns.items.size(); ++k) {
      const Value& turn = turns.items[k];
      const std::string here = at + "/turns/" + std::to_string(k);
      const scene::Vec3 axis = vector(*turn.find("axis"));
      const double length = std::hypot(axis[0], axis[1], axis[2]);
      if (!(length > 0.0)) {
        fault(here + "/axis", "an axis has a length other than 0");
        continue;
      }
      f.turns.push_back(
          {(1.0 / length) * axis, placed_law(*turn.find("angle"), here + "/angle", turn.find("rate")->truth)});
    }
    return f;
  }

  int index_of(const Value& name, const std::string& at) {
    if (name.text == "ground") return 0;
    const auto found = std::find(names_.begin() + 1, names_.end(), name.text);
    if (found != names_.end()) return static_cast<int>(found - names_.begin());
    if (!all_named_) return 0;  // the fault of the frame itself was reported
    fault(at, "no frame has this name", did_you_mean(name.text.str(), names_));
    return 0;
  }

  std::vector<std::string> names_ = {"ground"};
  bool all_named_ = true;
  std::vector<std::pair<std::string, laws::Law>>
      placed_laws_;  ///< with their pointers, integrated where they are rates
};

}  // namespace

FrameFile read_frames_text(std::string_view text, std::string name) {
  FrameFile file;
  FrameConverter converter;
  read_document(text, frame_rules(), converter, file);
  file.study = std::move(converter.study);
  file.study.name = std::move(name);
  return file;
}

FrameFile read_frames(const std::filesystem::path& file) {
  return read_document_file<FrameFile>(
      file, [&](const std::string& text) { return read_frames_text(text, file.stem().string()); });
}

std::string frames_schema_text() { return schema_text_of(frame_rules(), "bough frames"); }

}  // namespace bough::io
