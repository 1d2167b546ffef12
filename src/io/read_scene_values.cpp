#include <cmath>

#include "bough/laws/make_law.hpp"
#include "bough/motion/se3.hpp"
#include "law_kinds.hpp"
#include "read_scene_impl.hpp"

namespace bough::io {

using scene::Mat3;
using scene::Mat6;
using scene::Vec3;

Vec3 ValueConverter::vector(const Value& v) const {
  return {{v.items[0].number, v.items[1].number, v.items[2].number}};
}

Vec3 ValueConverter::vector_or(const Value& object, const char* key, const Vec3& otherwise) const {
  const Value* v = object.find(key);
  return v == nullptr ? otherwise : vector(*v);
}

double ValueConverter::number_or(const Value& object, const char* key, double otherwise) const {
  const Value* v = object.find(key);
  return v == nullptr ? otherwise : v->number;
}

std::string ValueConverter::text_or(const Value& object, const char* key) const {
  const Value* v = object.find(key);
  return v == nullptr ? std::string() : v->text;
}

Mat3 ValueConverter::matrix3(const Value& v) const {
  Mat3 r = Mat3::zero();
  for (int i = 0; i < 3; ++i) {
    const Value& row = v.items[static_cast<std::size_t>(i)];
    if (row.is(JsonKind::number)) r(i, i) = row.number;
    for (int j = 0; row.is(JsonKind::array) && j < 3; ++j) r(i, j) = row.items[static_cast<std::size_t>(j)].number;
  }
  return r;
}

Mat6 ValueConverter::matrix6(const Value& v) const {
  Mat6 r = Mat6::zero();
  for (int i = 0; i < 6; ++i) {
    const Value& row = v.items[static_cast<std::size_t>(i)];
    if (row.is(JsonKind::number)) r(i, i) = row.number;
    for (int j = 0; row.is(JsonKind::array) && j < 6; ++j) r(i, j) = row.items[static_cast<std::size_t>(j)].number;
  }
  return r;
}

void ValueConverter::warn_of_degrees(const Value& angle, const std::string& at) {
  const double x = std::abs(angle.number);
  if (x > largest_angle)
    fault(at, "this angle is too large: no digit of it tells a direction", "angles are in rad");
  else if (x > 10.0)
    warnings.push_back({at, "", "this angle is in radians (rad): it is more than one and a half turns",
                        "for degrees multiply by pi/180 = 0.017453292519943295"});
}

Mat3 ValueConverter::rotation_from_axes(const Value& axes, const std::string& at) {
  std::vector<std::pair<int, Vec3>> given;
  for (std::size_t i = 0; i < axes.items.size(); ++i)
    if (axes.items.key(i) != "comment") given.emplace_back(axes.items.key(i)[0] - '0', vector(axes.items[i]));
  if (given.size() != 2) {
    fault(at, "has to give exactly two of the axes \"1\", \"2\", \"3\"");
    return Mat3::identity();
  }
  const auto [k, main] = given[0];
  const auto [other, side] = given[1];
  // axes_from takes the axis after k; the one before it is minus the one after, turned by the cross product
  const bool is_next = other == k % 3 + 1;
  const auto R = scene::axes_from(k, main, is_next ? side : Vec3(cross(side, main)));
  if (R) return *R;
  fault(at, "the two axes are parallel, or one of them is 0");
  return Mat3::identity();
}

Mat3 ValueConverter::rotation(const Value& v, const std::string& at) {
  if (const Value* axis = v.find("axis")) {
    const Vec3 a = vector(*axis);
    const double length = std::hypot(a[0], a[1], a[2]);
    warn_of_degrees(*v.find("angle"), at + "/angle");
    if (std::abs(v.find("angle")->number) > largest_angle) return Mat3::identity();  // a fault
    if (length > least_axis) return motion::exp_so3(Vec3((v.find("angle")->number / length) * a));
    fault(at + "/axis", "an axis has a length other than 0");
  } else if (const Value* q = v.find("quaternion")) {
    const motion::Quaternion<double> raw = {q->items[0].number,
                                            {{q->items[1].number, q->items[2].number, q->items[3].number}}};
    const double length = std::hypot(raw.w, std::hypot(raw.v[0], raw.v[1], raw.v[2]));
    if (std::abs(length - 1.0) <= 1e-3) return motion::rotation_of(motion::normalise(raw));
    fault(at + "/quaternion", "a rotation is a quaternion of length 1, scalar first");
  } else if (const Value* psi = v.find("rotation_vector")) {
    const Vec3 turn = vector(*psi);
    if (std::hypot(turn[0], turn[1], turn[2]) <= largest_angle) return motion::exp_so3(turn);
    fault(at + "/rotation_vector", "this angle is too large: no digit of it tells a direction", "angles are in rad");
  } else if (const Value* axes_given = v.find("axes")) {
    return rotation_from_axes(*axes_given, at + "/axes");
  }
  return Mat3::identity();
}

scene::Placement ValueConverter::placement(const Value& v, const std::string& at) {
  scene::Placement p;
  p.pose.x = vector_or(v, "position");
  if (const Value* r = v.find("rotation")) p.pose.R = rotation(*r, at + "/rotation");
  p.frame = text_or(v, "frame");
  if (p.frame == "ground") p.frame.clear();
  return p;
}

scene::LoadAxes Converter::axes(const Value& v) const {
  return text_or(v, "axes") == "body" ? scene::LoadAxes::body : scene::LoadAxes::space;
}

laws::Law Converter::load_law(const Value& object, const std::string& at, std::string& signal) {
  if (const Value* v = object.find("law")) return law_or_signal(*v, at + "/law", signal);
  if (!is_static_) return laws::make_constant(1.0);
  const Value* analysis = root_.find("analysis");
  const Value* kind = analysis != nullptr ? analysis->find("kind") : nullptr;
  const bool is_path =
      analysis != nullptr && (analysis->find("arc_length") != nullptr || (kind != nullptr && kind->text == "buckling"));
  return is_path ? laws::make_expression("t") : laws::make_ramp(0.0, 1.0, 0.0, 1.0);
}

laws::Law ValueConverter::law(const Value& v, const std::string& at) {
  if (v.is(JsonKind::number)) return laws::make_constant(v.number);
  try {
    if (const Value* formula = v.find("expression")) return laws::make_expression(formula->text);
    const std::string& name = v.find("kind")->text;
    for (const LawKind& kind : law_kinds())
      if (kind.name == name)
        return kind.make(v, at, [this](const Value& part, const std::string& there) { return law(part, there); });
    return {};  // the rules take no other names
  } catch (const laws::LawError& e) {
    if (const Value* formula = v.find("expression"))
      fault(at + "/expression", e.what(),
            "at character " + std::to_string(e.position + 1) + ": " +
                shown_in_quotes(formula->text.str().substr(std::min(e.position, formula->text.str().size())), 20));
    else
      fault(at, e.what());
    return {};
  }
}

}  // namespace bough::io
