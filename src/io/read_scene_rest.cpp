#include <algorithm>

#include "bough/elements/coupling_kinds.hpp"
#include "bough/laws/formula.hpp"
#include "bough/laws/make_law.hpp"
#include "bough/scene/components.hpp"
#include "formats/result_format.hpp"
#include "named_numbers.hpp"
#include "read_analysis.hpp"
#include "read_scene_impl.hpp"

namespace bough::io {

std::string Converter::own_name(const Value& v, const char* stem) {
  if (const Value* name = v.find("name")) return name->text;
  std::string name;
  do {
    name = std::string(stem) + "_" + std::to_string(++unnamed_);
  } while (!names_.insert(name).second);
  return name;
}

/// A frame by its name; the ground is no name.
std::string Converter::frame_name(const Value& v) const {
  std::string name = text_or(v, "frame");
  if (name == "ground") name.clear();
  return name;
}

void Converter::load(const Value& v, const std::string& at) {
  std::string signal;
  const laws::Law factor = load_law(v, at, signal);
  if (const Value* where = v.find("at")) {
    scene::PointLoad l;
    l.name = own_name(v, "load");
    l.at = attachment(*where, at + "/at");
    l.axes = axes(v);
    l.frame = frame_name(v);
    l.force = vector(*v.find("force"));
    l.moment = vector(*v.find("moment"));
    l.law = factor;
    l.signal = signal;
    add(scene.point_loads, "point_loads", std::move(l), at);
  } else {
    scene::LineLoad l;
    l.name = own_name(v, "load");
    l.beam = v.find("beam")->text;
    l.axes = axes(v);
    l.frame = frame_name(v);
    l.force = vector(*v.find("force"));
    l.moment = vector(*v.find("moment"));
    l.law = factor;
    l.signal = signal;
    add(scene.line_loads, "line_loads", std::move(l), at);
  }
}

void Converter::motion(const Value& v, const std::string& at) {
  scene::PrescribedMotion m;
  m.name = own_name(v, "motion");
  m.at = attachment(*v.find("at"), at + "/at");
  const char* const names[3] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k)
    if (const Value* d = v.find(names[k]))
      m.displacement[k] = law_or_signal(*d, at + "/" + names[k], m.displacement_signal[k]);
  if (const Value* r = v.find("rotation")) {
    m.hold_rotation = r->is(JsonKind::string);
    if (r->is(JsonKind::object)) {
      m.rotation_axis = vector(*r->find("axis"));
      m.angle = law_or_signal(*r->find("angle"), at + "/rotation/angle", m.angle_signal);
      if (!v.find("rate")->truth) warn_of_degrees(m.angle, at + "/rotation/angle");
    }
  }
  m.is_rate = v.find("rate")->truth;
  add(scene.motions, "motions", std::move(m), at);
}

void Converter::initial_velocity(const Value& v, const std::string& at) {
  scene::InitialVelocity i;
  i.of = v.find("of")->text;
  i.axes = axes(v);
  i.frame = frame_name(v);
  i.velocity = vector(*v.find("velocity"));
  const Value* angular = v.find("angular_velocity");
  i.has_angular_velocity = angular != nullptr;
  if (angular != nullptr) i.angular_velocity = vector(*angular);
  add(scene.initial_velocities, "initial_velocities", std::move(i), at);
}

void Converter::sensor(const Value& v, const std::string& at) {
  scene::Sensor s;
  s.name = v.find("name")->text;
  s.kind = scene::sensor_kind_named(v.find("kind")->text).value();  // the schema takes no other names
  if (const Value* where = v.find("at")) s.at = attachment(*where, at + "/at");
  s.beam = text_or(v, "beam");
  s.joint = text_or(v, "joint");
  s.coordinate = text_or(v, "coordinate");
  s.signal = text_or(v, "signal");
  s.subdomain = text_or(v, "subdomain");
  if (s.kind == scene::SensorKind::joint_effort)
    s.of = effort_part(v);
  else
    s.part = text_or(v, "of");
  s.axes = axes(v);
  s.frame = frame_name(v);
  if (const Value* chain = v.find("frames"))
    for (const Value& name : chain->items) s.chain.push_back(name.text);
  s.station = number_or(v, "station", 0.0);
  s.component = text_or(v, "component");
  if (v.find("beam") != nullptr && v.find("station") == nullptr && scene::type_of(s.kind).of != scene::SensorOf::beam)
    fault(at, "needs the key \"station\"", "0 is the start of the beam, 1 its end");
  if (v.find("at") != nullptr && v.find("station") != nullptr) fault(at + "/station", "a station goes with a beam");
  add(scene.sensors, "sensors", std::move(s), at);
}

void Converter::read_expected_value(const Value& v, scene::Expected& e) const {
  e.value = v.find("value")->number;
  e.tolerance = number_or(v, "tolerance", 0.0);
  e.relative_tolerance = number_or(v, "relative_tolerance", 0.0);
  e.source = text_or(v, "source");
}

void Converter::expected(const Value& v, const std::string& at) {
  scene::Expected e;
  e.quantity = v.find("quantity")->text;
  const std::string figure = text_or(v, "figure");
  for (int k = 0; k <= static_cast<int>(scene::FigureKind::period); ++k)
    if (scene::to_string(static_cast<scene::FigureKind>(k)) == figure) e.figure = static_cast<scene::FigureKind>(k);
  if (const Value* time = v.find("time")) e.time = time->number;
  if (const Value* level = v.find("level")) e.level = level->number;
  read_expected_value(v, e);
  add(scene.expected, "expected", std::move(e), at);
}

void Converter::measure(const Value& v, const std::string& at) {
  scene::Measure m;
  m.name = v.find("name")->text;
  m.quantity = text_or(v, "quantity");
  m.expression = text_or(v, "expression");
  for (int k = 0; k <= static_cast<int>(scene::MeasureKind::equivalent_range); ++k)
    if (scene::to_string(static_cast<scene::MeasureKind>(k)) == text_or(v, "figure"))
      m.kind = static_cast<scene::MeasureKind>(k);
  const auto optional = [&v](const char* key) {
    const Value* given = v.find(key);
    return given == nullptr ? std::nullopt : std::optional<double>(given->number);
  };
  m.from = optional("from");
  m.to = optional("to");
  m.time = optional("time");
  m.level = optional("level");
  m.target = optional("target");
  m.cycles = optional("cycles");
  m.percent = number_or(v, "percent", m.percent);
  m.band = number_or(v, "band", m.band);
  m.range = number_or(v, "range", m.range);
  m.exponent = number_or(v, "exponent", m.exponent);
  if (v.find("value") != nullptr) {
    read_expected_value(v, m.expected.emplace());
  } else {
    for (const char* key : {"tolerance", "relative_tolerance", "source"})
      if (v.find(key) != nullptr) fault(at + "/" + key, "goes with a \"value\" that the measure has to be");
  }
  if (!measure_names_.insert(m.name).second)
    fault(at + "/name", "another measure has this name", "names are used once");
  if (m.kind == scene::MeasureKind::settling_time && v.find("band") == nullptr)
    fault(at, "needs the key \"band\"", "how far from the target counts as settled");
  read_measured_names(v, at, m);
  add(scene.measures, "measures", std::move(m), at);
}

/// The quantities to which an expression refers.
void Converter::read_measured_names(const Value& v, const std::string& at, scene::Measure& m) {
  const Value* of = v.find("of");
  if (m.expression.empty()) {
    if (of != nullptr) fault(at + "/of", "goes with an \"expression\"");
    return;
  }
  std::vector<std::string> names;
  for (std::size_t i = 0; of != nullptr && i < of->items.size(); ++i) {
    const std::string& name = of->items.key(i);
    if (name == "comment") continue;
    if (const std::string rule = NamedNumbers::fault_of_name(name); !rule.empty())
      fault(pointer_to(at + "/of", name), rule);
    names.push_back(name);
    m.names.emplace_back(name, of->items[i].text);
  }
  const auto is_measure = [&](const auto& named) {
    const std::string sensor = named.second.substr(0, named.second.find('.'));
    return named.second != m.name && measure_names_.count(named.second) > 0 &&
           std::none_of(scene.sensors.begin(), scene.sensors.end(), [&](const auto& s) { return s.name == sensor; });
  };
  const auto num_measures = static_cast<std::size_t>(std::count_if(m.names.begin(), m.names.end(), is_measure));
  m.is_of_measures = num_measures > 0;
  if (num_measures > 0 && num_measures < m.names.size())
    fault(at + "/of", "names quantities of sensors and measures, and an expression is of the ones or of the others");
  if (m.is_of_measures && (m.kind != scene::MeasureKind::value || m.time))
    fault(at, "measures are numbers of the whole run, so their expression has no figure over time",
          "leave out \"figure\" and \"time\"");
  if (names.empty())
    return fault(at, "an expression needs the key \"of\" with its quantities", "\"of\": {\"x\": \"tip.x\"}");
  try {
    (void)laws::Formula(m.expression, names);
  } catch (const laws::LawError& e) {
    fault(at + "/expression", e.what());
  }
}

/// Warns of keys that have no effect with the other choices.
scene::SolverForm Converter::read_form(const Value& solver) {
  const auto form_named = [](const std::string& name) {  // "automatic" and "hierarchical" were names of the first
    const std::vector<std::string>& names = scene::solver_form_names();
    const auto known = std::find(names.begin(), names.end(), name);
    return known == names.end() ? scene::SolverForm::local : static_cast<scene::SolverForm>(known - names.begin());
  };
  const std::string form = text_or(solver, "form"), kind = text_or(solver, "kind");
  if (!form.empty() && !kind.empty() && form_named(form) != form_named(kind))
    fault("/solver/kind", "is the former name of form, which is \"" + form + "\": leave one of them out");
  return form_named(form.empty() ? kind : form);
}

void Converter::warn_of_idle_settings(const Value& analysis) {
  const auto is_given = [&analysis](const char* key) {
    const Value* v = analysis.find(key);
    return v != nullptr && v->source != source_default;
  };
  const auto warn = [&](const char* key, const std::string& why, const std::string& hint) {
    if (is_given(key)) warnings.push_back({std::string("/analysis/") + key, "", "this has no effect: " + why, hint});
  };
  if (is_given("arc_length"))
    warn("load_steps", "the path is followed by arc_length instead", "leave out one of load_steps and arc_length");
  if (is_static_) return;
  const std::string integrator = text_or(analysis, "integrator");
  const std::string chosen = "the integrator is " + (integrator.empty() ? "generalized_alpha" : integrator);
  if (integrator == "bdf" || integrator == "variational")
    warn("spectral_radius", chosen, "it belongs to generalized_alpha: leave it out");
  if (integrator != "bdf") warn("bdf_order", chosen, "it belongs to bdf: leave it out");
  if (integrator != "variational") warn("newmark_beta", chosen, "it belongs to variational: leave it out");
}

void Converter::settings() {
  const auto sound = [&](const char* key) {
    const Value* v = root_.find(key);
    return v != nullptr && v->sound ? v : nullptr;
  };
  if (const Value* title = sound("title")) scene.title = title->text;
  if (const Value* g = sound("gravity")) {
    const Value* factor = g->is(JsonKind::object) ? g->find("law") : nullptr;
    const bool is_of_signal = factor != nullptr && factor->is(JsonKind::object) && factor->find("signal") != nullptr;
    if (g->is(JsonKind::object) && (is_of_signal || g->find("vector") == nullptr)) {
      driven_gravity(*g);
    } else {
      scene.gravity = vector(g->is(JsonKind::array) ? *g : *g->find("vector"));
      std::string signal;  // none
      scene.gravity_law = load_law(g->is(JsonKind::array) ? Value{} : *g, "/gravity", signal);
    }
  }
  if (const Value* a = sound("analysis")) {
    read_analysis(*a, scene.analysis);
    scene.analysis.frame = frame_name(*a);
    warn_of_idle_settings(*a);
  } else {
    defective.push_back("/analysis");
  }
  if (const Value* s = sound("solver")) {
    scene.solver.form = read_form(*s);
    const std::string& library = s->find("library")->text;
    scene.solver.library = library == "klu"         ? scene::SolverLibrary::klu
                           : library == "sparse_lu" ? scene::SolverLibrary::sparse_lu
                           : library == "umfpack"   ? scene::SolverLibrary::umfpack
                                                    : scene::SolverLibrary::cholmod;
    scene.solver.iterate_interface = s->find("interface_solution")->text == "iterative";
    scene.solver.leaf_size = whole_number<int>(number_or(*s, "leaf_size", 0.0));
    scene.solver.depth = whole_number<int>(number_or(*s, "depth", -1.0));
    scene.solver.penalty_factor = number_or(*s, "penalty_factor", 1.0);
    if (scene.solver.form != scene::SolverForm::augmented && s->find("penalty_factor") != nullptr)
      fault("/solver/penalty_factor", "only the form \"augmented\" adds a penalty",
            "leave it out, or choose that form");
    scene.solver.tasks = s->find("tasks")->truth;
    scene.solver.threads = whole_number<int>(s->find("threads")->number);
  }
  if (const Value* o = sound("output")) {
    scene.output.stride = whole_number<int>(o->find("stride")->number);
    scene.output.motion = o->find("motion")->truth;
    if (const Value* n = o->find("motion_stride")) scene.output.motion_stride = whole_number<int>(n->number);
    scene.output.checks = o->find("checks")->truth;
    scene.output.checkpoint = number_or(*o, "checkpoint", 300.0);
    scene.output.checkpoint_time = number_or(*o, "checkpoint_time", 0.0);
    if (const Value* formats = o->find("formats"))
      for (const Value& name : formats->items) scene.output.formats.push_back(name.text);
    for (const ResultFormat& format : result_formats())
      scene.output.motion |=
          format.draws && std::count(scene.output.formats.begin(), scene.output.formats.end(), format.name) > 0;
  }
  if (const Value* w = sound("without"))
    for (const Value& name : w->items) scene.without.push_back(name.text);
}

void Converter::each(const char* list, const std::function<void(const Value&, const std::string&)>& read) {
  const Value* items = root_.find(list);
  if (items == nullptr || !items->is(JsonKind::array)) return;
  for (std::size_t i = 0; i < items->items.size(); ++i) {
    const Value& v = items->items[i];
    faults_before_ = faults.size();
    left_out_ = !v.sound;
    if (v.sound) read(v, pointer_to(pointer_to("", list), std::to_string(i)));
    if (faults.size() == faults_before_ && !left_out_) continue;
    const Value* name = v.is(JsonKind::object) ? v.find("name") : nullptr;
    if (name == nullptr || !name->is(JsonKind::string)) continue;
    if (std::string_view(list) == "materials")
      defective_materials_.insert(name->text);
    else
      defective.push_back(name->text);
  }
}

void Converter::convert() {
  for (const Value& list : root_.items) {
    if (!list.is(JsonKind::array)) continue;
    for (const Value& item : list.items)
      if (const Value* name = item.is(JsonKind::object) ? item.find("name") : nullptr; name != nullptr)
        names_.insert(name->text);
  }
  const Value* analysis = root_.find("analysis");
  const Value* kind = analysis != nullptr && analysis->is(JsonKind::object) ? analysis->find("kind") : nullptr;
  const auto known = kind != nullptr ? scene::analysis_kind_named(kind->text.str()) : std::nullopt;
  is_static_ = known && !scene::type_of(*known).is_in_time;
  find_signal_names();
  settings();
  each("frames", &Converter::frame);
  each("materials", &Converter::material);
  each("sections", &Converter::section);
  each("nodes", &Converter::node);
  each("bodies", &Converter::body);
  each("beams", &Converter::beam);
  poses_.emplace(scene);  // no places are added after this
  warn_of_thick_beams();
  tell_meshes();
  each("joints", &Converter::joint);
  for (const scene::CouplingKind* kind : elements::coupling_kinds())
    each(kind->list, [&](const Value& v, const std::string& at) { coupling(*kind, v, at); });
  each("actuators", &Converter::actuator);
  each("loads", &Converter::load);
  each("motions", &Converter::motion);
  each("initial_velocities", &Converter::initial_velocity);
  each("signals", &Converter::signal);
  each("sensors", &Converter::sensor);
  each("expected", &Converter::expected);
  each("measures", &Converter::measure);
  tell_places_in_chosen_meshes();
  weigh();
}

}  // namespace bough::io
