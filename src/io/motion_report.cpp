#include "bough/io/motion_report.hpp"

#include "bough/io/json_text.hpp"
#include "bough/io/number_text.hpp"

namespace bough::io {
namespace {

using motion::MotionKind;

constexpr int digits = 9;

std::string_view name_of(MotionKind kind) {
  switch (kind) {
    case MotionKind::none:
      return "none";
    case MotionKind::translation:
      return "translation";
    case MotionKind::screw:
      break;
  }
  return "screw";
}

/// The text printed in place of a number that does not exist.
std::string missing(const motion::MotionReport& r, const std::string& what) {
  return r.intrinsic.kind == MotionKind::none ? "none: no motion" : "none: " + what;
}

class Table {
 public:
  template <int N>
  void add(const std::string& name, const lanes::Vec<double, N>& v) {
    rows.push_back({name});
    for (int k = 0; k < N; ++k) rows.back().push_back(rounded_text(v[k], digits));
  }
  template <int R, int C>
  void add(const std::string& name, const lanes::Mat<double, R, C>& a) {
    for (int i = 0; i < R; ++i) {
      rows.push_back({i == 0 ? name : ""});
      for (int j = 0; j < C; ++j) rows.back().push_back(rounded_text(a(i, j), digits));
    }
  }
  void add(const std::string& name, double x) { rows.push_back({name, rounded_text(x, digits)}); }
  void add(const std::string& name, const std::string& text) { rows.push_back({name, text}); }
  template <class T>
  void add(const std::string& name, const std::optional<T>& v, const std::string& otherwise) {
    if (v)
      add(name, *v);
    else
      add(name, otherwise);
  }

  std::vector<std::vector<std::string>> rows;
};

template <int N>
void write(JsonText& json, const lanes::Vec<double, N>& v) {
  json.begin_array();
  for (int k = 0; k < N; ++k) json.value(v[k]);
  json.end_array();
}
template <int R, int C>
void write(JsonText& json, const lanes::Mat<double, R, C>& a) {
  json.begin_array();
  for (int i = 0; i < R; ++i) {
    json.begin_array();
    for (int j = 0; j < C; ++j) json.value(a(i, j));
    json.end_array();
  }
  json.end_array();
}
void write(JsonText& json, double x) { json.value(x); }

template <class T>
void member(JsonText& json, std::string_view name, const T& v) {
  json.key(name);
  write(json, v);
}
template <class T>
void member(JsonText& json, std::string_view name, const std::optional<T>& v) {
  if (v) member(json, name, *v);
}

lanes::Vec<double, 4> components_of(const motion::Quaternion<double>& q) { return {{q.w, q.v[0], q.v[1], q.v[2]}}; }

void write_screw(JsonText& json, const motion::MotionReport& r) {
  const motion::IntrinsicMotion& m = r.intrinsic;
  json.begin_object();
  json.member("kind", name_of(m.kind));
  member(json, "angle", m.phi);
  member(json, "displacement", m.d);
  if (m.kind != MotionKind::none) member(json, "direction", m.n);
  if (m.kind == MotionKind::screw) member(json, "moment", m.w);
  member(json, "pitch", r.pitch);
  member(json, "axis_point", r.axis_point);
  member(json, "axis_line", r.axis_line);
  json.end_object();
}

}  // namespace

std::vector<std::vector<std::string>> motion_rows(const motion::MotionReport& r) {
  Table t;
  t.add("displacement u [m]", r.motion.x);
  t.add("rotation R", r.motion.R);
  t.add("rotation angle phi [rad]", r.angle);
  t.add("rotation axis n", r.axis, "none: no rotation");
  t.add("rotation vector phi n [rad]", r.rotation_vector);
  t.add("quaternion (w, x, y, z)", components_of(r.quaternion));
  t.add("half-angle rotation G, R = G G", r.half_angle);
  t.add("kind of motion", std::string(name_of(r.intrinsic.kind)));
  t.add("intrinsic displacement d [m]", r.intrinsic.d);
  t.add("pitch 2 pi d/phi [m]", r.pitch, missing(r, "infinite"));
  t.add("Mozzi-Chasles axis, nearest point [m]", r.axis_point, missing(r, "any line along u"));
  t.add("Mozzi-Chasles axis (moment; direction)", r.axis_line, missing(r, "any line along u"));
  for (const motion::ParameterReport& p : r.parameters) {
    const std::string name = std::string(p.name) + " parameters, " + std::string(p.law);
    t.add(name, p.motion, "none: infinite at half a turn");
  }
  t.add("exponential coordinates (u; psi)", r.exponential_coordinates);
  t.add("motion tensor C", r.motion_tensor);
  t.add("C^-1", r.inverse_motion_tensor);
  t.add("unit eigenvector N1", r.first_eigenvector, missing(r, ""));
  t.add("unit eigenvector N2", r.second_eigenvector, missing(r, "no screw"));
  t.add("|R^T R - I|", r.rotation_defect);
  return std::move(t.rows);
}

std::string motion_json(const motion::MotionReport& r) {
  JsonText json;
  json.begin_object();
  json.member("units", "m, rad");
  member(json, "displacement", r.motion.x);
  json.key("rotation");
  json.begin_object();
  member(json, "angle", r.angle);
  member(json, "axis", r.axis);
  member(json, "rotation_vector", r.rotation_vector);
  member(json, "quaternion", components_of(r.quaternion));
  member(json, "matrix", r.motion.R);
  member(json, "half_angle_matrix", r.half_angle);
  member(json, "defect", r.rotation_defect);
  json.end_object();
  json.key("screw");
  write_screw(json, r);
  json.key("parameters");
  json.begin_array();
  for (const motion::ParameterReport& p : r.parameters) {
    json.begin_object();
    json.member("name", p.name);
    json.member("law", p.law);
    member(json, "rotation", p.rotation);
    member(json, "motion", p.motion);
    json.end_object();
  }
  json.end_array();
  member(json, "exponential_coordinates", r.exponential_coordinates);
  member(json, "motion_tensor", r.motion_tensor);
  member(json, "inverse_motion_tensor", r.inverse_motion_tensor);
  member(json, "first_eigenvector", r.first_eigenvector);
  member(json, "second_eigenvector", r.second_eigenvector);
  json.end_object();
  return json.text();
}

}  // namespace bough::io
