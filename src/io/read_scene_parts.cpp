#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "bough/scene/outlines.hpp"
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
    left_out_ = true;  // not reported: the material's fault was
    return nullptr;
  }
  std::vector<std::string> known;
  if (!search_.is_spent())
    for (const scene::Material& material : materials_) known.push_back(material.name);
  fault(at, "no material has this name", materials_.empty() ? "the scene has no materials" : did_you_mean(name, known));
  return nullptr;
}

std::vector<std::array<double, 2>> Converter::corners(const Value& list) const {
  std::vector<std::array<double, 2>> loop;
  for (const Value& point : list.items) loop.push_back({point.items[0].number, point.items[1].number});
  return loop;
}

bool Converter::is_sound(const scene::Outline& outline, const std::string& at) {
  const std::string problem = scene::problem_in(outline);
  if (!problem.empty()) fault(at, problem);
  return problem.empty();
}

std::optional<scene::SectionShape> Converter::section_shape(const Value& s, const std::string& at) {
  const auto get = [&](const char* key) { return s.find(key)->number; };
  const std::string& kind = s.find("kind")->text;
  const auto has_room = [&](const char* key, double needed, double there, const char* words) {
    if (needed < there) return true;
    fault(at + "/" + key, words);
    return false;
  };
  if (kind == "rectangle") return scene::Rectangle{get("width"), get("height")};
  if (kind == "circle") return scene::Circle{get("radius")};
  if (kind == "ellipse") return scene::Ellipse{get("width"), get("height")};
  if (kind == "tube") {
    if (!has_room("inner_radius", get("inner_radius"), get("outer_radius"), "has to be below the outer radius"))
      return {};
    return scene::Tube{get("outer_radius"), get("inner_radius")};
  }
  if (kind == "box" || kind == "l") {
    const double w = get("width"), h = get("height"), t = get("thickness");
    const double walls = kind == "box" ? 2.0 * t : t;
    if (!has_room("thickness", walls, std::min(w, h), "the walls leave nothing between them: they have to be thinner"))
      return {};
    if (kind == "box") return scene::HollowBox{w, h, t};
    return scene::LProfile{w, h, t};
  }
  if (kind == "i" || kind == "c") {
    if (!has_room("web", get("web"), get("width"), "has to be below the width") ||
        !has_room("flange", 2.0 * get("flange"), get("height"), "twice this has to be below the height"))
      return {};
    if (kind == "i") return scene::IProfile{get("width"), get("height"), get("web"), get("flange")};
    return scene::CProfile{get("width"), get("height"), get("web"), get("flange")};
  }
  std::optional<scene::Outline> polygon = outline(s, at);
  if (!polygon) return {};
  return scene::Polygon{std::move(*polygon)};
}

scene::Section Converter::shaped_section(const Value& v, const std::string& at) {
  const Value& s = *v.find("shape");
  const std::optional<scene::SectionShape> shape = section_shape(s, at + "/shape");
  const scene::Material* m = material_named(v.find("material")->text, at + "/material");
  if (m == nullptr || !shape) return {};
  warn_of_thickness(s, *m, at);
  thickness_[v.find("name")->text] =
      std::max({number_or(s, "width", 0.0), number_or(s, "height", 0.0), 2.0 * number_or(s, "radius", 0.0),
                2.0 * number_or(s, "outer_radius", 0.0)});
  scene::AreaFigures figures = scene::area_figures(*shape);
  const Value* factors = v.find("shear_factors");
  if (factors != nullptr) {
    figures.shear_factor_2 = factors->items[0].number;
    figures.shear_factor_3 = factors->items[1].number;
    figures.shear_factor_23 = 0.0;
  }
  if (std::holds_alternative<scene::Polygon>(*shape)) {
    if (factors == nullptr)
      fault(at, "needs the key \"shear_factors\"",
            "those of a polygon are not computed; a compact one has about [0.85, 0.85]");
    const Value* torsion = s.find("torsion_constant");
    if (torsion == nullptr)
      fault(at + "/shape", "needs the key \"torsion_constant\"", "that of a polygon is not computed");
    if (torsion != nullptr) figures.torsion = torsion->number;
    figures.shear_center_2 = s.find("shear_center")->items[0].number;
    figures.shear_center_3 = s.find("shear_center")->items[1].number;
  }
  const std::string& kind = s.find("kind")->text;
  if (kind == "i" || kind == "c" || kind == "l")
    warnings.push_back({at + "/shape", "",
                        "the warping of this open section is left out: it twists as easily where its ends are held",
                        "give `stiffness` and `mass` where warping counts, and this shape as `outline`"});
  return scene::make_section(v.find("name")->text, *shape, figures, *m);
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
    if (const Value* o = v.find("outline")) s.shape = section_shape(*o, at + "/outline");
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
    if (has_other) return fault(at, "density and material go with a shape", "give the mass with an inertia");
    if (mass == nullptr) fault(at, "needs the key \"mass\"");
    const bool is_diagonal = inertia->items[0].is(JsonKind::number);
    body.inertia = is_diagonal ? diagonal3(inertia->items[0].number, inertia->items[1].number, inertia->items[2].number)
                               : matrix3(*inertia);
    return;
  }
  const Value& s = *shape_value;
  const std::string& kind = s.find("kind")->text;
  const int axis = whole_number<int>(number_or(s, "axis", 1.0));
  scene::BodyShape shape;
  if (kind == "box") shape = scene::Box{vector(*s.find("size"))};
  if (kind == "cylinder") shape = scene::Cylinder{s.find("radius")->number, s.find("length")->number, axis};
  if (kind == "sphere") shape = scene::Sphere{s.find("radius")->number};
  if (kind == "rod") shape = scene::Rod{s.find("length")->number, axis};
  if (kind == "capsule") shape = scene::Capsule{s.find("radius")->number, s.find("length")->number, axis};
  if (kind == "cone")
    shape = scene::Cone{s.find("radius")->number, s.find("end_radius")->number, s.find("length")->number, axis};
  if (kind == "ring") {
    const double outer = s.find("outer_radius")->number, inner = s.find("inner_radius")->number;
    if (inner >= outer) return fault(at + "/shape/inner_radius", "has to be below the outer radius");
    shape = scene::Ring{outer, inner, s.find("length")->number, axis};
  }
  if (kind == "extrusion") {
    std::optional<scene::Outline> polygon = outline(s, at + "/shape");
    if (!polygon) return;
    if (polygon->loops.size() > 1) return fault(at + "/shape/file", "the polygon of an extrusion has no holes");
    shape = scene::Extrusion{std::move(*polygon), s.find("length")->number, axis};
  }
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
  body.shape = shape;
}

void Converter::body(const Value& v, const std::string& at) {
  scene::Body b;
  b.name = v.find("name")->text;
  b.placement = placement(v, at);
  b.center_of_mass = vector(*v.find("center_of_mass"));
  b.is_point_mass = v.find("kind")->text == "point_mass";
  body_inertia(v, at, b);
  body_looks(v, at, b);
  add(scene.bodies, "bodies", std::move(b), at);
}

/// A mesh that the scene leaves open: one that resolves the bending of a beam under loads along it, and large rotations.
void Converter::choose_mesh(const Value& v, scene::Beam& b) {
  constexpr int nodes = 12, nodes_of_curve = 24;  // beside the first
  const Value *elements = v.find("elements"), *order = v.find("order");
  b.order = order != nullptr ? whole_number<int>(order->number) : elements != nullptr ? 1 : 3;
  if (elements != nullptr) {
    b.elements = whole_number<int>(elements->number);
    return;
  }
  b.elements = (v.find("curve") != nullptr ? nodes_of_curve : nodes) / b.order;
  beams_without_mesh.push_back(b.name);
}

/// Says which meshes were chosen.
void Converter::tell_meshes() {
  if (beams_without_mesh.empty()) return;
  constexpr std::size_t most_named = 4;
  std::string names;
  for (std::size_t i = 0; i < std::min(beams_without_mesh.size(), most_named); ++i)
    names += (i == 0 ? "'" : ", '") + beams_without_mesh[i] + "'";
  if (beams_without_mesh.size() > most_named)
    names += " and " + std::to_string(beams_without_mesh.size() - most_named) + " more beams";
  warnings.push_back({"/beams", "", "the mesh of " + names + " is chosen: twelve nodes beside the first, 24 on a curve",
                      "give \"elements\" and \"order\"; a run with twice as many elements tells the error of a mesh"});
}

/// Says which inner nodes of these stand for places.
void Converter::tell_places_in_chosen_meshes() {
  for (const auto& [name, at] : inner_nodes) {
    const std::string of = name.substr(0, name.rfind('.'));
    if (std::find(beams_without_mesh.begin(), beams_without_mesh.end(), of) == beams_without_mesh.end()) continue;
    const auto beam =
        std::find_if(scene.beams.begin(), scene.beams.end(), [&of](const auto& b) { return b.name == of; });
    const double nodes = beam->elements * beam->order;
    const double place = std::strtod(name.c_str() + name.rfind('.') + 1, nullptr) / nodes;
    warnings.push_back({at, "\"" + name + "\"",
                        "this is an inner node of a mesh that is chosen: it stands at " + rounded_text(place, 3) +
                            " of the beam, and elsewhere in another mesh",
                        "give the beam its \"elements\" and \"order\", or a node of its own to this place"});
  }
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
  choose_mesh(v, b);
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
