/// Steady vibrations about a state under harmonic inputs.
#include <cmath>
#include <memory>
#include <numbers>

#include "at_state.hpp"
#include "bough/io/number_text.hpp"
#include "bough/scene/linear_inputs.hpp"
#include "bough/step/harmonic.hpp"
#include "linear_ports.hpp"
#include "not_judged.hpp"

namespace bough::run {

namespace {

using step::Linearisation;
using Part = Linearisation::Part;

constexpr double is_solution = 1e-6;       ///< residual over its terms above which there is no solution
constexpr double symmetric_enough = 1e-9;  ///< relative difference from a symmetric matrix that is round-off

/// Frequency responses  y / u = H(i w)  of all outputs to all inputs, and with spectra of inputs those of the outputs.
class Response final : public AtState {
 public:
  explicit Response(const Parts& parts) : AtState(parts) {}
  std::unique_ptr<Analysis> clone() const override { return std::make_unique<Response>(*this); }
  std::string not_judged() const override {
    return one_line({plan_.beams.empty() ? "" : the_mesh, "amplitudes are those of small motions"});
  }

 protected:
  bool look(Linearisation& linear) override;

 private:
  using Complex = std::complex<double>;
  using Rows = std::vector<std::vector<Complex>>;  ///< by frequency: of every output to every input

  std::vector<Complex> outputs_at(OutputSlopes& slopes, double w, const step::Harmonic::Vector& x) const;
  /// Two a signal for an input that is none of the scene: the input, and the sum with its law.
  int num_signals_of_inputs() const;
  void tell_resonances(Linearisation& linear);
  records::Table table_of(const Rows& rows) const;
  void add_spectra(const Rows& rows);

  std::vector<LinearPort> inputs_, outputs_;
  double residual_ = 0.0;
};

std::vector<Response::Complex> Response::outputs_at(OutputSlopes& slopes, double w,
                                                    const step::Harmonic::Vector& x) const {
  const std::size_t n = x.size();
  std::vector<double> part(n), rate(n), second(n);
  std::vector<Complex> y(outputs_.size());
  for (const Complex unit : {Complex(1.0, 0.0), Complex(0.0, 1.0)}) {
    // x e^(i w t) with rates i w x and -w^2 x: their real parts, then their imaginary parts.
    for (std::size_t i = 0; i < n; ++i) {
      const Complex value = std::conj(unit) * x[i], of_rate = Complex(0.0, w) * value;
      part[i] = value.real();
      rate[i] = of_rate.real();
      second[i] = -w * w * value.real();
    }
    const std::vector<double>& all = slopes.eval(part, rate, second, w);
    for (std::size_t k = 0; k < outputs_.size(); ++k) y[k] += unit * all[outputs_[k].place];
  }
  return y;
}

bool Response::look(Linearisation& linear) {
  inputs_ = inputs_of(scene_, system_);
  outputs_ = outputs_of(scene_, summary().header);
  OutputSlopes slopes(system_, state_, about_);
  step::Harmonic harmonic(linear);
  step::Harmonic::Vector x;
  std::vector<double> force(linear.size(), 0.0);
  Rows rows;
  for (const double frequency : scene_.analysis.linear.frequencies) {
    const double w = 2.0 * std::numbers::pi * frequency;
    const solve::FactorStatus status = harmonic.factor(w);
    std::vector<Complex>& row = rows.emplace_back();
    for (const LinearPort& input : inputs_) {
      force[input.place] = 1.0;
      const double left = status.ok() ? harmonic.solve(force, x) : 1.0;
      force[input.place] = 0.0;
      if (!(left < is_solution))
        return fail("at " + io::rounded_text(frequency, 9) + " Hz there is no steady vibration under '" + input.name +
                    "': the structure resonates there without damping, or some motion has neither stiffness nor "
                    "inertia; give dampers or damping of sections, or take other frequencies");
      residual_ = std::max(residual_, left);
      const std::vector<Complex> y = outputs_at(slopes, w, x);
      row.insert(row.end(), y.begin(), y.end());
    }
    if (!may_try(0.0)) return false;
  }
  summary().tables.push_back(table_of(rows));
  add_spectra(rows);
  tell_resonances(linear);
  return true;
}

int Response::num_signals_of_inputs() const {
  int count = 0;
  for (const scene::LinearInput& input : scene_.analysis.linear.inputs)
    count += scene::place_of(scene_, input).kind == scene::InputPlace::Kind::signal ? 1 : 2;
  return count;
}

/// Of equations without damping the number of modes below a frequency, by the inertia of a factor, changes where a
/// resonance lies, however narrow it is.
void Response::tell_resonances(Linearisation& linear) {
  const std::vector<double>& frequencies = scene_.analysis.linear.frequencies;
  // Signals that stand for inputs alone are no part of the equations without inputs.
  if (plan_.num_driving_signals != num_signals_of_inputs() || linear.largest(Part::damping) > 0.0) return;
  linear.leave_out_signals();
  if (linear.asymmetry(Part::stiffness) > symmetric_enough) return;
  int before = -1;
  std::string where;
  int count = 0;
  for (std::size_t k = 0; k < frequencies.size(); ++k) {
    const double w = 2.0 * std::numbers::pi * frequencies[k];
    if (!linear.factor({.mass = -w * w}, solve::Symmetry::symmetric).ok()) return;
    const int below = linear.num_negative();
    if (below < 0) return;
    if (before >= 0 && below != before && ++count <= 6)
      where += (where.empty() ? "" : ", ") + io::rounded_text(frequencies[k - 1], 6) + " and " +
               io::rounded_text(frequencies[k], 6);
    before = below;
  }
  if (count > 0)
    note("nothing is damped, and the structure resonates between " + where + " Hz" +
         (count > 6 ? " and " + std::to_string(count - 6) + " times more" : "") +
         ": no steady vibration is reached there, and how high a peak is depends on the frequencies alone");
}

/// "m per N": of an output to an input.
std::string unit_of_response(const LinearPort& output, const LinearPort& input) {
  if (input.unit.empty()) return output.unit;
  return (output.unit.empty() ? "1" : output.unit) + "/" +
         (input.unit.find(' ') == std::string::npos ? input.unit : "(" + input.unit + ")");
}

records::Table Response::table_of(const Rows& rows) const {
  records::Table table{"response", "", {{"frequency", "Hz", true}}, {}};
  for (const LinearPort& input : inputs_)
    for (const LinearPort& output : outputs_) {
      const std::string by = inputs_.size() > 1 ? output.name + " by " + input.name : output.name;
      table.columns.push_back({by + " amplitude", unit_of_response(output, input), true});
      table.columns.push_back({by + " phase", "deg", true});
    }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    std::vector<records::Table::Cell> row{scene_.analysis.linear.frequencies[k]};
    for (const Complex& value : rows[k]) {
      row.emplace_back(std::abs(value));
      row.emplace_back(std::arg(value) * 180.0 / std::numbers::pi);
    }
    table.rows.push_back(std::move(row));
  }
  std::string names;
  for (const LinearPort& input : inputs_) names += (names.empty() ? "'" : ", '") + input.name + "'";
  table.about =
      "Steady vibrations about " + about_.text() + ", under " + names +
      " of amplitude 1: amplitudes, and phases by which outputs are ahead. What is left of the equations is " +
      io::rounded_text(residual_, 2) + " of their terms at most.";
  return table;
}

/// S_y = sum |H|^2 S_u over independent inputs, between given frequencies linear in both; rms^2 = integral of S_y over
/// the frequencies of the response, by the trapezoidal rule.
void Response::add_spectra(const Rows& rows) {
  const std::vector<double>& frequencies = scene_.analysis.linear.frequencies;
  const std::vector<scene::LinearInput>& asked = scene_.analysis.linear.inputs;
  const auto has = [](const scene::LinearInput& input) { return !input.spectrum.empty(); };
  if (std::none_of(asked.begin(), asked.end(), has)) return;
  const auto density = [](const auto& spectrum, double f) {
    if (spectrum.empty() || f < spectrum.front().first || f > spectrum.back().first) return 0.0;
    for (std::size_t k = 1; k < spectrum.size(); ++k)
      if (f <= spectrum[k].first) {
        const double part = (f - spectrum[k - 1].first) / (spectrum[k].first - spectrum[k - 1].first);
        return spectrum[k - 1].second + part * (spectrum[k].second - spectrum[k - 1].second);
      }
    return spectrum.back().second;
  };
  records::Table table{"spectra", "", {{"frequency", "Hz", true}}, {}};
  for (const LinearPort& output : outputs_)
    table.columns.push_back({output.name, (output.unit.empty() ? "1" : "(" + output.unit + ")^2") + "/Hz", true});
  std::vector<double> squares(outputs_.size(), 0.0), before;
  for (std::size_t k = 0; k < rows.size(); ++k) {
    std::vector<double> sums(outputs_.size(), 0.0);
    for (std::size_t u = 0; u < asked.size(); ++u)
      for (std::size_t y = 0; y < outputs_.size(); ++y)
        sums[y] += std::norm(rows[k][u * outputs_.size() + y]) * density(asked[u].spectrum, frequencies[k]);
    for (std::size_t y = 0; y < outputs_.size() && k > 0; ++y)
      squares[y] += 0.5 * (sums[y] + before[y]) * (frequencies[k] - frequencies[k - 1]);
    std::vector<records::Table::Cell> row{frequencies[k]};
    row.insert(row.end(), sums.begin(), sums.end());
    table.rows.push_back(std::move(row));
    before = std::move(sums);
  }
  table.about = "One-sided power spectral densities of outputs under independent random inputs with the spectra given.";
  summary().tables.push_back(std::move(table));
  records::Table rms{"rms",
                     "Root mean squares of outputs: the integrals of their spectra over the frequencies of the "
                     "response, by the trapezoidal rule.",
                     {{"output", "", true}, {"rms", "", true}, {"unit", "", true}},
                     {}};
  for (std::size_t y = 0; y < outputs_.size(); ++y)
    rms.rows.push_back({outputs_[y].name, std::sqrt(squares[y]), outputs_[y].unit});
  summary().tables.push_back(std::move(rms));
}

}  // namespace

std::unique_ptr<Analysis> make_response(const Parts& parts) { return std::make_unique<Response>(parts); }

}  // namespace bough::run
