#include <algorithm>
#include <array>
#include <cmath>

#include "bough/io/number_text.hpp"
#include "read_analysis.hpp"
#include "schema_parts.hpp"

namespace bough::io {

namespace {

using scene::Analysis;
using Value = JsonValue;

/// A key of an analysis: its rule, and what its value is to the scene. The value is given, or the default of the rule;
/// without either the scene keeps its own default.
struct Option {
  Field field;
  void (*read)(const Value& value, Analysis& analysis);
};

/// What an analysis of one kind is asked. Its name is in the table of kinds.
struct KindOptions {
  scene::AnalysisKind kind;
  Literal about;
  std::vector<Option> options;
};

int whole(const Value& v) { return whole_number<int>(v.number); }

/// Sets a number where the object has one for this key.
void take_number_of(const Value& object, const char* key, double& number) {
  if (const Value* v = object.find(key)) number = v->number;
}

/// The words of a key whose values are a list of kinds, in the order of their numbers.
template <std::size_t N>
auto kind_of_word(const std::array<const char*, N>& words, const Value& v) {
  return static_cast<int>(std::find(words.begin(), words.end(), v.text) - words.begin());
}
template <std::size_t N>
RuleRef rule_of_words(const std::array<const char*, N>& words) {
  return word_rule("", {words.begin(), words.end()});
}
constexpr std::array newton_words{"full", "single"};
constexpr std::array start_words{"given", "equilibrium"}, about_words{"start", "equilibrium"};
constexpr std::array integrator_words{"generalized_alpha", "variational", "bdf"};

Option max_cuts(Literal about) {
  return {may("max_cuts", integer_rule("", 0, 60), about, "10"),
          [](const Value& v, Analysis& a) { a.max_cuts = whole(v); }};
}

Option end_time() {
  return {need("end_time", positive(""), "[s]."), [](const Value& v, Analysis& a) { a.end_time = v.number; }};
}

Option step_size(Literal about) {
  return {may("step_size", positive(""), about), [](const Value& v, Analysis& a) { a.step_size = v.number; }};
}

/// What all analyses are asked that solve equations of equilibrium or of motion.
std::vector<Option> newton_options() {
  return {{may("newton", rule_of_words(newton_words), "full: to convergence. single: one linear solution per step.",
               "\"full\""),
           [](const Value& v, Analysis& a) { a.newton = static_cast<scene::Newton>(kind_of_word(newton_words, v)); }},
          {may("tolerance", number_rule("", 0.0, true, 1e-2),
               "Of relative motions, and of residuals relative to their contributions [-].", "1e-8"),
           [](const Value& v, Analysis& a) { a.tolerance = v.number; }},
          {may("max_iterations", integer_rule("", 1, 1000), "Newton's limit per step.", "20"),
           [](const Value& v, Analysis& a) { a.max_iterations = whole(v); }},
          max_cuts("Halvings of a step before the run fails.")};
}

Option arc_length() {
  Rule rule = object_of(
      "Follows the path of equilibria, past limit points of the load, in steps of equal length (spherical arc length) "
      "instead of load steps. Ends where the load factor passes end_load_factor, or at a limit point.",
      {may("step", number_rule("", 0.0, true, 1.0),
           "Length of the first step: root mean square over nodes of displacements over the size of the structure and "
           "rotations in rad [-]. Default: 0.05, shorter where the path bends sharply at its start."),
       may("largest_step", number_rule("", 0.0, true, 10.0), "[-]. Default: four times step, or 0.2."),
       may("max_steps", integer_rule("", 1, 1e6), "More steps are an error.", "1000"),
       may("end_load_factor", number_rule(""), "Where the run ends. Default: 1."),
       may("after_limit_points", integer_rule("", 0, 1000), "Limit points to pass before end_load_factor counts."),
       may("end_at_limit_point", integer_rule("", 1, 1000), "Number of the limit point at which the run ends.")});
  rule.at_most_one = {{"end_load_factor", "end_at_limit_point"}, {"after_limit_points", "end_at_limit_point"}};
  return {may("arc_length", made(std::move(rule)), "Statics past limit points. Default: load steps."),
          [](const Value& v, Analysis& a) {
            scene::ArcLength& l = a.arc_length.emplace();
            take_number_of(v, "step", l.step);
            take_number_of(v, "largest_step", l.largest_step);
            take_number_of(v, "end_load_factor", l.end_load_factor);
            l.max_steps = whole(*v.find("max_steps"));
            if (const Value* after = v.find("after_limit_points")) l.after_limit_points = whole(*after);
            if (const Value* end = v.find("end_at_limit_point")) l.end_at_limit_point = whole(*end);
          }};
}

/// What runs beside the run tell of its errors. time_about: what the errors in time are of.
Option errors(Literal time_about) {
  Rule rule =
      object_of("Twins of the run, which measure the errors of all results.",
                {may("time", boolean_rule(""), time_about, "false"),
                 may("mesh", boolean_rule(""),
                     "Twins with half and a quarter of the elements of all beams, or with two and four times as "
                     "many where these numbers cannot be halved.",
                     "false")});
  return {may("errors", made(std::move(rule)),
              "Errors of the results, measured by further runs beside this one; bough plan tells what they cost. "
              "Default: none are measured."),
          [](const Value& v, Analysis& a) {
            a.errors.time = v.find("time")->truth;
            a.errors.mesh = v.find("mesh")->truth;
          }};
}

/// about: what is found that reaches it.
Option accuracy(Literal about) {
  const RuleRef relative = number_rule("Of the range of every sensor [-].", 0.0, true, 0.5);
  Rule rule = object_of(
      "Of some results, or not relative.",
      {may("relative", number_rule("", 0.0, true, 0.5), "Of the range of a sensor, or of the size of a measure [-]."),
       may("absolute", positive(""), "In the unit of what it is of; allowed beside the relative one."),
       may("of", array_rule("", text_rule(""), 1, 1000),
           "Names of sensors, of their columns (\"tip.x\") and of measures. Default: all sensors."),
       may("mesh", boolean_rule(""), "Errors by the numbers of elements count, too.", "true")});
  return {may("accuracy", choice_rule("Largest error of results.", {relative, made(std::move(rule))}), about),
          [](const Value& v, Analysis& a) {
            scene::Accuracy& asked = a.accuracy.emplace();
            if (v.is(JsonKind::number)) {
              asked.relative = v.number;
              return;
            }
            take_number_of(v, "relative", asked.relative);
            take_number_of(v, "absolute", asked.absolute);
            if (const Value* of = v.find("of"))
              for (const Value& name : of->items) asked.of.push_back(name.text.str());
            asked.mesh = v.find("mesh")->truth;
          }};
}

Option step_control() {
  Rule rule = object_of("Step sizes chosen from the local error of each step (generalized_alpha).",
                        {may("tolerance", number_rule("", 0.0, true, 0.1),
                             "Of the sum of local errors over the run, relative to the size of the structure, 1 rad "
                             "and the largest speeds so far [-].",
                             "1e-4"),
                         may("position_tolerance", number_rule("", 0.0), "Allowed beside [m].", "0"),
                         may("rotation_tolerance", number_rule("", 0.0), "Allowed beside [rad].", "0"),
                         may("velocity_tolerance", number_rule("", 0.0), "Allowed beside [m/s].", "0"),
                         may("angular_velocity_tolerance", number_rule("", 0.0), "Allowed beside [rad/s].", "0"),
                         may("largest_step", positive(""), "[s]. Default: a fiftieth of the end time.")});
  return {may("step_control", made(std::move(rule)),
              "Step sizes chosen so that errors follow a tolerance; step_size is then that of the first step. Default: "
              "steps of equal size."),
          [](const Value& v, Analysis& a) {
            scene::StepControl& c = a.step_control.emplace();
            take_number_of(v, "tolerance", c.tolerance);
            take_number_of(v, "position_tolerance", c.position_tolerance);
            take_number_of(v, "rotation_tolerance", c.rotation_tolerance);
            take_number_of(v, "velocity_tolerance", c.velocity_tolerance);
            take_number_of(v, "angular_velocity_tolerance", c.angular_velocity_tolerance);
            take_number_of(v, "largest_step", c.largest_step);
          }};
}

std::vector<Option> static_options() {
  return {
      {may("load_steps", integer_rule("", 1, 1e6), "Steps of the load factor from 0 to 1.", "1"),
       [](const Value& v, Analysis& a) { a.load_steps = whole(v); }},
      arc_length(),
      {may("unstable", boolean_rule(""),
           "Unstable equilibria are what is looked for: the run is not doubted because of them.", "false"),
       [](const Value& v, Analysis& a) { a.unstable = v.truth; }},
      errors("A twin with twice as many load steps: equilibria do not depend on them, unless a step leads to "
             "another one."),
      accuracy("Largest error that results may have by the mesh: numbers of elements are multiplied until it is met. "
               "Default: the mesh is that of the scene.")};
}

std::vector<Option> dynamic_options() {
  return {
      end_time(),
      {may("start", rule_of_words(start_words),
           "given: the poses of the scene. equilibrium: the static equilibrium under gravity, loads and efforts at "
           "time "
           "0, relative to `frame` if that moves, with drives and prescribed motions in their places; initial "
           "velocities are added to it.",
           "\"given\""),
       [](const Value& v, Analysis& a) { a.start = static_cast<scene::StartKind>(kind_of_word(start_words, v)); }},
      step_size("h [s]. Default: 1e-3, or with `accuracy` a 256th of the end time."),
      {may("integrator", rule_of_words(integrator_words),
           "generalized_alpha: second order; damps what is faster than the step. variational: keeps the momentum of "
           "what floats freely to round-off, and energy within a bound where the step resolves the fastest vibration; "
           "it damps nothing and is not suited to stiff scenes with vibrations that the step does not resolve: they "
           "ring or grow, and a run ends with an error where energy comes out of nothing. bdf: third order (or second, "
           "see bdf_order), for smooth motions to high accuracy; undamped vibrations of some 3 to 12 steps a period "
           "grow at order 3.",
           "\"generalized_alpha\""),
       [](const Value& v, Analysis& a) {
         a.integrator = static_cast<scene::Integrator>(kind_of_word(integrator_words, v));
       }},
      {may("spectral_radius", number_rule("", 0.0, false, 1.0),
           "Of generalized_alpha at high frequency: 0 damps most, 1 not at all [-].", "0.8"),
       [](const Value& v, Analysis& a) { a.spectral_radius = v.number; }},
      {may("bdf_order", integer_rule("", 2, 3),
           "Of bdf: 2 damps every vibration, 3 is more accurate where none is undamped. Default: 3, but 2 where the "
           "start has an undamped vibration of 3 to 12 steps a period, which order 3 makes grow; the run says so."),
       [](const Value& v, Analysis& a) { a.bdf_order = whole(v); }},
      {may("newmark_beta", number_rule("", 0.25, false, 1.0),
           "Of variational, for vibrations: 0.25 is the most accurate; more slows down those faster than the step, "
           "which is no cure for stiff scenes [-].",
           "0.3"),
       [](const Value& v, Analysis& a) { a.newmark_beta = v.number; }},
      step_control(),
      errors("Twins with steps of twice and four times the size."),
      accuracy("Largest error that results may have: a step size is found that meets it, and numbers of elements are "
               "multiplied until they do. step_size and these numbers are those of the first "
               "trial. Default: steps and mesh are those of the scene.")};
}

/// What all analyses are asked that linearise the equations about a state.
std::vector<Option> about_options() {
  return {
      {may("about", rule_of_words(about_words),
           "start: the state of the scene at time 0, with its velocities. equilibrium: the static equilibrium under "
           "gravity, loads and efforts at time 0, relative to `frame` if that moves; initial velocities are kept, "
           "so that what spins has its gyroscopic moments.",
           "\"equilibrium\""),
       [](const Value& v, Analysis& a) { a.start = static_cast<scene::StartKind>(kind_of_word(about_words, v)); }},
      {may("tolerance", number_rule("", 0.0, true, 1e-2), "Of the equilibrium, as in dynamics [-].", "1e-8"),
       [](const Value& v, Analysis& a) { a.tolerance = v.number; }}};
}

std::vector<Option> modes_options() {
  return {
      {may("count", integer_rule("", 1, 10000),
           "Vibrations that are looked for. Rigid and unstable motions are listed besides, and all modes of the last "
           "frequency where it has several.",
           "10"),
       [](const Value& v, Analysis& a) { a.modes.count = whole(v); }},
      {may("shift", number_rule("", 0.0, false), "Frequency next to which they are looked for [Hz]; 0: the slowest.",
           "0"),
       [](const Value& v, Analysis& a) { a.modes.shift = v.number; }},
      {may("damping", boolean_rule(""),
           "Dampers and damping of sections count: damping ratios and complex shapes. Otherwise they are left out; "
           "gyroscopic terms, loads that follow and signals count in any case.",
           "false"),
       [](const Value& v, Analysis& a) { a.modes.damping = v.truth; }}};
}

/// What acts on linearised equations and what is looked at. more: further members of an input.
std::vector<Option> port_options(std::vector<Field> more) {
  std::vector<Field> members{
      need("of", text_rule(""), "A load, a prescribed motion, a joint with a drive or an effort, or an input signal."),
      may("component", text_rule(""),
          "Of a prescribed motion \"x\", \"y\", \"z\" or \"angle\", of a joint its coordinate; needed where there are "
          "several.")};
  members.insert(members.end(), more.begin(), more.end());
  return {{need("inputs",
                array_rule("",
                           choice_rule("What is excited, by a name alone where it has one component.",
                                       {text_rule("Its name."), made(object_of("", std::move(members)))}),
                           1, 1000),
                "Each is a number that is added to the factor of a load, to a prescribed coordinate [m, rad], to an "
                "effort [N, N m], or to an input signal."),
           [](const Value& v, Analysis& a) {
             for (const Value& item : v.items) {
               scene::LinearInput& input = a.linear.inputs.emplace_back();
               if (item.is(JsonKind::string)) {
                 input.of = item.text.str();
                 continue;
               }
               input.of = item.find("of")->text.str();
               if (const Value* component = item.find("component")) input.component = component->text.str();
               if (const Value* spectrum = item.find("spectrum"))
                 for (const Value& point : spectrum->items)
                   input.spectrum.emplace_back(point.items[0].number, point.items[1].number);
             }
           }},
          {may("outputs", array_rule("", text_rule(""), 1, 1000), "Names of sensors. Default: all."),
           [](const Value& v, Analysis& a) {
             for (const Value& item : v.items) a.linear.outputs.push_back(item.text.str());
           }}};
}

Option frequencies() {
  Rule range =
      object_of("A range.",
                {need("from", not_negative(""), "[Hz]."), need("to", positive(""), "[Hz]."),
                 may("count", integer_rule("", 2, 100000), "Of frequencies.", "200"),
                 may("spacing", word_rule("", {"logarithmic", "linear"}), "Default: logarithmic, but linear from 0.")});
  return {need("frequencies",
               choice_rule("Frequencies [Hz].", {array_rule("A list.", not_negative(""), 1, 100000), made(range)}),
               "At which steady vibrations are computed, each by a factorization of its own."),
          [](const Value& v, Analysis& a) {
            std::vector<double>& list = a.linear.frequencies;
            if (v.is(JsonKind::array)) {
              for (const Value& item : v.items) list.push_back(item.number);
              return;
            }
            const double from = v.find("from")->number, to = v.find("to")->number;
            const int count = whole(*v.find("count"));
            const Value* spacing = v.find("spacing");
            const bool is_linear = spacing != nullptr ? spacing->text == "linear" : !(from > 0.0);
            for (int k = 0; k < count; ++k) {
              const double part = static_cast<double>(k) / (count - 1);
              list.push_back(is_linear || !(from > 0.0) ? from + part * (to - from) : from * std::pow(to / from, part));
            }
            list.back() = to;
          }};
}

std::vector<Option> response_options() {
  std::vector<Option> options = port_options({may(
      "spectrum", array_rule("", array_rule("Frequency [Hz] and density.", not_negative(""), 2, 2), 2, 100000),
      "One-sided power spectral density of a random input, linear between these points and zero outside [square of "
      "its unit per Hz]: outputs then have spectra and root mean squares.")});
  options.push_back(frequencies());
  return options;
}

std::vector<Option> buckling_options() {
  return {
      {may("count", integer_rule("", 1, 1000),
           "Critical load factors that are looked for, the lowest; all of the last one where it has several shapes.",
           "1"),
       [](const Value& v, Analysis& a) { a.buckling.count = whole(v); }},
      {may("largest_factor", positive(""), "Load factor beyond which none is looked for [-].", "1e12"),
       [](const Value& v, Analysis& a) { a.buckling.largest_factor = v.number; }},
      {may("tolerance", number_rule("", 0.0, true, 1e-2), "Of equilibria, as in statics [-].", "1e-10"),
       [](const Value& v, Analysis& a) { a.tolerance = v.number; }},
      {may("max_iterations", integer_rule("", 1, 1000), "Newton's limit per load step.", "20"),
       [](const Value& v, Analysis& a) { a.max_iterations = whole(v); }}};
}

/// A list of numbers, or a range of equal distances.
RuleRef values_rule(Literal about) {
  return choice_rule(
      about, {array_rule("A list, ascending.", number_rule(""), 2, 1000),
              made(object_of("A range.",
                             {need("from", number_rule(""), "The first."), need("to", number_rule(""), "The last."),
                              may("count", integer_rule("", 2, 1000), "Of values.", "21")}))});
}

std::vector<Option> campbell_options() {
  static constexpr std::array speed_units{"rad/s", "rpm", "Hz"};
  return {
      {need("parameter", text_rule(""),
            "JSON pointer to the number that varies, as \"/parameters/speed\" where formulas of the scene read it."),
       [](const Value& v, Analysis& a) { a.campbell.parameter = v.text.str(); }},
      {need("values", values_rule("What it is."), "Values of the parameter."),
       [](const Value& v, Analysis& a) {
         std::vector<double>& list = a.campbell.values;
         if (v.is(JsonKind::array)) {
           for (const Value& item : v.items) list.push_back(item.number);
           return;
         }
         const double from = v.find("from")->number, to = v.find("to")->number;
         const int count = whole(*v.find("count"));
         for (int k = 0; k < count; ++k) list.push_back(from + (to - from) * k / (count - 1));
         list.back() = to;
       }},
      {may("speed", rule_of_words(speed_units),
           "Unit in which the parameter is a speed of rotation: excitations by multiples of it are drawn, and critical "
           "speeds are located. Default: it is no speed."),
       [](const Value& v, Analysis& a) {
         static constexpr double in_radians[] = {1.0, 3.14159265358979323846 / 30.0, 2.0 * 3.14159265358979323846};
         a.campbell.speed = in_radians[kind_of_word(speed_units, v)];
       }},
      {may("orders", array_rule("", positive(""), 1, 100), "Multiples of the speed that excite.", "[1]"),
       [](const Value& v, Analysis& a) {
         for (const Value& item : v.items) a.campbell.orders.push_back(item.number);
       }}};
}

std::vector<Option> joined(std::vector<Option> options, const std::vector<Option>& further) {
  options.insert(options.end(), further.begin(), further.end());
  return options;
}

/// What each kind of analysis is asked; schema and reader are made of it.
const std::vector<KindOptions>& kinds() {
  using scene::AnalysisKind;
  static const std::vector<KindOptions> list = {
      {AnalysisKind::statics, "Equilibrium at load factors up to 1, or under prescribed motions.",
       joined(static_options(), newton_options())},
      {AnalysisKind::dynamics, "Motion in time.", joined(dynamic_options(), newton_options())},
      {AnalysisKind::inverse_dynamics,
       "Efforts of drives and reactions for a motion that drives and prescribed motions determine completely, "
       "evaluated "
       "at given times: nothing is integrated. Refused where a part can still move, bend or follow a state.",
       {end_time(),
        step_size("Distance h of the times 0, h, 2 h, ... at which the motion is evaluated, besides those of expected "
                  "figures; no result depends on it [s]. Default: 1e-3."),
        max_cuts("Halvings of the way between two times where parts move far."),
        errors("There are none: nothing is integrated.")}},
      {AnalysisKind::modes,
       "Modes of vibration about a state: frequencies, damping, shapes, effective masses, and what moves and bends in "
       "each.",
       joined(about_options(), modes_options())},
      {AnalysisKind::response,
       "Steady vibrations about a state under harmonic inputs: amplitude and phase of sensors over the frequency, and "
       "spectra under random inputs. Dampers and damping of sections count.",
       joined(about_options(), response_options())},
      {AnalysisKind::linear_model,
       "The linearised equations about a state between inputs and sensors as matrices, E x' = A x + B u, y = C x + D "
       "u, "
       "and in minimal coordinates where these have up to 500 states. Dampers and damping of sections count.",
       joined(about_options(), port_options({}))},
      {AnalysisKind::buckling,
       "Load factors at which a structure buckles, each about the shape that it has under its load there, and the "
       "shapes "
       "in which it does. Loads without a law, and gravity, grow with the load factor.",
       buckling_options()},
      {AnalysisKind::campbell,
       "Modes about a state over a parameter of the scene, as the speed of a rotor: branches that are followed through "
       "crossings, critical speeds and onsets of growth.",
       joined(joined(about_options(), modes_options()), campbell_options())}};
  return list;
}

}  // namespace

void add_analysis_rules(RuleTable& t, const Field& frame) {
  std::vector<RuleRef> rules;
  for (const KindOptions& k : kinds()) {
    std::vector<Field> fields;
    for (const Option& o : k.options) fields.push_back(o.field);
    fields.push_back(frame);
    rules.push_back(made(object_of_kind({std::string(scene::type_of(k.kind).name)}, k.about, std::move(fields))));
  }
  t.named["analysis"] = choice_rule("What is computed.", std::move(rules));
}

void read_analysis(const Value& v, Analysis& analysis) {
  const Value* name = v.find("kind");
  analysis.kind = scene::analysis_kind_named(name->text.str()).value();  // the schema takes no other names
  for (const KindOptions& k : kinds())
    if (k.kind == analysis.kind)
      for (const Option& o : k.options)
        if (const Value* given = v.find(o.field.key.data())) o.read(*given, analysis);
  constexpr double first_steps = 256.0;
  if (analysis.accuracy && v.find("step_size") == nullptr && analysis.end_time > 0.0)
    analysis.step_size = analysis.end_time / first_steps;
}

}  // namespace bough::io
