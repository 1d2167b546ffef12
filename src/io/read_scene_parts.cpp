#include <algorithm>
#include <cmath>

#include "bough/scene/nearest_name.hpp"
#include "bough/scene/shapes.hpp"
#include "read_scene_impl.hpp"

namespace bough::io {
namespace {

scene::Mat3 diagonal3(double a, double b, double c) {
  scene::Mat3 r = scene::Mat3::zero();
  r(0, 0) = a;
  r(1, 1) = b;
  r(2, 2) = c;
  return r;
}

}  // namespace

void Converter::frame(const Value& v, const std::string& at) {
  scene::MovingFrame m;
  m.name = v.find("name")->text;
  bool moves = false;
  for (std::size_t k = 0; k < 3; ++k) {
    m.position[k] = law(v.find("position")->items[k], at + "/position/" + std::to_string(k));
    moves |= !m.position[k].is_constant();
  }
  if (const Value* r = v.find("rotation")) m.rotation = rotation(*r, at + "/rotation");
  const Value& turns = *v.find("turns");
  for (std::size_t k = 0; k < turns.items.size(); ++k) {
    const Value& turn = turns.items[k];
    const std::string here = at + "/turns/" + std::to_string(k);
    const scene::Vec3 axis = vector(*turn.find("axis"));
    const double length = std::hypot(axis[0], axis[1], axis[2]);
    if (!(length > least_axis)) {
      fault(here + "/axis", length > 0.0 ? "this axis is too short to tell a direction: its length is near 0"
                                         : "an axis has a length other than 0");
      continue;
    }
    const laws::Law given = law(*turn.find("angle"), here + "/angle");
    if (!turn.find("rate")->truth) warn_of_degrees(given, here + "/angle");
    m.turns.push_back({(1.0 / length) * axis, turn.find("rate")->truth ? given.integral(0.0) : given});
    moves |= !m.turns.back().angle.is_constant();
  }
  if (const auto what = scene::non_finite_law(m, 0.0)) return fault(at, "a law is not finite at t = 0 s: " + *what);
  scene::FrameDef f;
  f.name = m.name;
  f.placement = {scene::motion_at(m, 0.0).pose, text_or(v, "frame")};
  if (f.placement.frame == "ground") f.placement.frame.clear();
  if (moves) f.motion = std::move(m);
  add(scene.frames, "frames", std::move(f), at);
}

void Converter::node(const Value& v, const std::string& at) {
  scene::Node n{v.find("name")->text, placement(v, at)};
  add(scene.nodes, "nodes", std::move(n), at);
}

void Converter::material(const Value& v, const std::string& at) {
  scene::Material m;
  m.name = v.find("name")->text;
  m.young = v.find("young")->number;
  const Value* nu = v.find("poisson");
  m.shear = nu != nullptr ? 0.5 * m.young / (1.0 + nu->number) : v.find("shear")->number;
  m.density = v.find("density")->number;
  if (!material_of_.emplace(m.name, materials_.size()).second)
    return fault(at + "/name", "another material has this name", "names are used once");
  warn_of_units(m, at);
  materials_.push_back(std::move(m));
}

const scene::Material* Converter::material_named(const std::string& name, const std::string& at) {
  if (const auto index = material_of_.find(name); index != material_of_.end()) return &materials_[index->second];
  if (defective_materials_.count(name) > 0) {
    left_out_ = true;  // without a word: the material's fault was reported
    return nullptr;
  }
  std::vector<std::string> known;
  constexpr std::size_t most = 1000;  // names compared with: the search goes over all of them for every fault
  for (std::size_t i = 0; i < std::min(most, materials_.size()); ++i) known.push_back(materials_[i].name);
  const std::string near = faults.size() < max_problems ? scene::nearest_name(name, known) : "";
  fault(at, "no material has this name",
        !near.empty()        ? "did you mean \"" + near + "\"?"
        : materials_.empty() ? "the scene has no materials"
                             : "");
  return nullptr;
}

scene::Section Converter::shaped_section(const Value& v, const std::string& at) {
  const Value& s = *v.find("shape");
  const auto get = [&](const char* key) { return s.find(key)->number; };
  const std::string& kind = s.find("kind")->text;
  scene::SectionShape shape;
  if (kind == "rectangle") shape = scene::Rectangle{get("width"), get("height")};
  if (kind == "circle") shape = scene::Circle{get("radius")};
  if (kind == "tube") {
    shape = scene::Tube{get("outer_radius"), get("inner_radius")};
    if (get("inner_radius") >= get("outer_radius"))
      fault(at + "/shape/inner_radius", "has to be below the outer radius");
  }
  const scene::Material* m = material_named(v.find("material")->text, at + "/material");
  if (m == nullptr) return {};
  warn_of_thickness(s, *m, at);
  thickness_[v.find("name")->text] =
      std::max({number_or(s, "width", 0.0), number_or(s, "height", 0.0), 2.0 * number_or(s, "radius", 0.0),
                2.0 * number_or(s, "outer_radius", 0.0)});
  std::optional<double> k2, k3;
  if (const Value* k = v.find("shear_factors")) {
    k2 = k->items[0].number;
    k3 = k->items[1].number;
  }
  return scene::make_section(v.find("name")->text, shape, *m, k2, k3);
}

scene::Mat6 Converter::section_mass(const Value& v) const {
  if (v.is(JsonKind::array)) return matrix6(v);
  return scene::section_mass_matrix(v.find("mass_per_length")->number, vector(*v.find("rotary")),
                                    vector(*v.find("center")));
}

void Converter::section(const Value& v, const std::string& at) {
  scene::Section s;
  if (v.find("shape") != nullptr) {
    s = shaped_section(v, at);
  } else {
    const Value& k = *v.find("stiffness");
    s.stiffness = s.mass = scene::Mat6::zero();
    const char* const names[6] = {"EA", "GA2", "GA3", "GJ", "EI2", "EI3"};
    if (k.is(JsonKind::array)) s.stiffness = matrix6(k);
    for (int i = 0; k.is(JsonKind::object) && i < 6; ++i) s.stiffness(i, i) = k.find(names[i])->number;
    if (const Value* m = v.find("mass")) s.mass = section_mass(*m);
  }
  s.name = v.find("name")->text;
  s.damping = scene::Mat6::zero();
  if (const Value* d = v.find("damping")) {
    if (d->is(JsonKind::array)) s.damping = matrix6(*d);
    if (const Value* time = d->find("time")) s.damping = time->number * s.stiffness;
  }
  add(scene.sections, "sections", std::move(s), at);
}

void Converter::body_inertia(const Value& v, const std::string& at, scene::Body& body) {
  const Value *inertia = v.find("inertia"), *shape_value = v.find("shape"), *mass = v.find("mass"),
              *density = v.find("density"), *material_name = v.find("material");
  if (mass != nullptr) body.mass = mass->number;
  const bool has_other = density != nullptr || material_name != nullptr;
  if (body.is_point_mass) {
    if (inertia != nullptr || shape_value != nullptr || has_other) fault(at, "a point mass has a mass only");
    if (mass == nullptr) fault(at, "needs the key \"mass\"");
    return;
  }
  if (inertia == nullptr && shape_value == nullptr)
    return fault(at, "needs exactly one of the keys \"inertia\" or \"shape\"",
                 "for a point mass write \"kind\": \"point_mass\"");
  if (shape_value == nullptr) {
    if (has_other) fault(at, "density and material go with a shape");
    if (mass == nullptr) fault(at, "needs the key \"mass\"");
    const bool is_diagonal = inertia->items[0].is(JsonKind::number);
    body.inertia = is_diagonal ? diagonal3(inertia->items[0].number, inertia->items[1].number, inertia->items[2].number)
                               : matrix3(*inertia);
    return;
  }
  const Value& s = *shape_value;
  const std::string& kind = s.find("kind")->text;
  const int axis = static_cast<int>(number_or(s, "axis", 1.0));
  scene::BodyShape shape;
  if (kind == "box") shape = scene::Box{vector(*s.find("size"))};
  if (kind == "cylinder") shape = scene::Cylinder{s.find("radius")->number, s.find("length")->number, axis};
  if (kind == "sphere") shape = scene::Sphere{s.find("radius")->number};
  if (kind == "rod") shape = scene::Rod{s.find("length")->number, axis};
  if (mass == nullptr && !has_other)
    return fault(at, "needs one of the keys \"mass\", \"density\" or \"material\" with its shape");
  if (has_other && kind == "rod") return fault(at, "a rod has no volume: give its mass");
  double rho = density != nullptr ? density->number : 0.0;
  if (material_name != nullptr) {
    const scene::Material* m = material_named(material_name->text, at + "/material");
    if (m == nullptr) return;
    rho = m->density;
    if (rho == 0.0) return fault(at + "/material", "this material has no density");
  }
  if (density != nullptr) warn_of_density(rho, at + "/density", v.find("name")->text);
  if (has_other) warn_of_body_size(s, at + "/shape", rho);
  if (has_other) body.mass = rho * scene::volume_of(shape);
  body.inertia = scene::inertia_of(shape, body.mass);
}

void Converter::body(const Value& v, const std::string& at) {
  scene::Body b;
  b.name = v.find("name")->text;
  b.placement = placement(v, at);
  b.center_of_mass = vector(*v.find("center_of_mass"));
  b.is_point_mass = v.find("kind")->text == "point_mass";
  body_inertia(v, at, b);
  add(scene.bodies, "bodies", std::move(b), at);
}

void Converter::beam(const Value& v, const std::string& at) {
  scene::Beam b;
  b.name = v.find("name")->text;
  b.section = v.find("section")->text;
  const auto end = [&](const char* key, std::string& name, std::optional<scene::Vec3>& offset) {
    const Value& e = *v.find(key);
    name = e.is(JsonKind::string) ? e.text : e.find("to")->text;
    if (e.is(JsonKind::object)) offset = vector(*e.find("position"));
  };
  end("start", b.start, b.start_offset);
  end("end", b.end, b.end_offset);
  b.axis_2 = vector_or(v, "axis_2");
  if (const Value* a = v.find("axis_2"); a != nullptr && lanes::dot(b.axis_2, b.axis_2) == 0.0)
    fault(at + "/axis_2", "a direction has a length other than 0");
  b.frame = text_or(v, "frame");
  b.twist = v.find("twist")->number;
  warn_of_degrees(*v.find("twist"), at + "/twist");
  b.elements = static_cast<int>(v.find("elements")->number);
  b.order = static_cast<int>(v.find("order")->number);
  if (const Value* c = v.find("curve")) {
    b.curve = scene::BeamCurve::curvature;
    b.curvature = vector(*c->find("curvature"));
    b.length = c->find("length")->number;
    b.tangent = vector(*c->find("tangent"));
    if (b.twist != 0.0) fault(at + "/twist", "a curved beam says its twist as the first component of its curvature");
  }
  add(scene.beams, "beams", std::move(b), at);
}

}  // namespace bough::io
