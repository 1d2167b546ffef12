#include "harmonic.hpp"

#include <cmath>
#include <memory>
#include <numbers>

#include "bough/laws/make_law.hpp"
#include "polynomial_pieces.hpp"
#include "quadrature.hpp"

namespace bough::laws {

namespace {

/// Below this omega [rad/s] the closed form of the second antiderivative loses more digits (eps / omega^2) than
/// quadrature does.
constexpr double slow_omega = 1e-2;

class Harmonic final : public Node {
 public:
  explicit Harmonic(const Wave& wave) : wave_(wave) {}

  LawValue at(double t, Side) const override {
    const double theta = wave_.omega * (t - wave_.start) + wave_.phase;
    const double wave = wave_.amplitude * std::sin(theta);
    return {wave_.offset + wave, wave_.amplitude * wave_.omega * std::cos(theta), -wave_.omega * wave_.omega * wave};
  }
  void append_breaks(double, double, int, BreakList&) const override {}
  Jet<Interval> range(double, double) const override {
    const double a = std::abs(wave_.amplitude), w = std::abs(wave_.omega);
    return {{wave_.offset - a, wave_.offset + a}, {-a * w, a * w}, {-a * w * w, a * w * w}};
  }
  Law integral(double t0) const override;

 private:
  Wave wave_;
};

/// int_t0^t of a wave, in a form that cancels nowhere (cos a - cos b as a product):
///   F = amplitude sin((theta(t) + theta(t0)) / 2) sin(omega d / 2) / (omega / 2) + offset d,   d = t - t0.
class HarmonicIntegral final : public Node {
 public:
  HarmonicIntegral(const Wave& wave, double t0) : wave_(wave), t0_(t0) {}

  LawValue at(double t, Side) const override {
    const double theta = wave_.omega * (t - wave_.start) + wave_.phase;
    const double d = t - t0_;
    const double half = 0.5 * wave_.omega;
    const double value = wave_.amplitude * std::sin(theta - half * d) * (std::sin(half * d) / half) + wave_.offset * d;
    return {value, wave_.offset + wave_.amplitude * std::sin(theta), wave_.amplitude * wave_.omega * std::cos(theta)};
  }
  void append_breaks(double, double, int, BreakList&) const override {}
  Jet<Interval> range(double, double) const override {
    const double a = std::abs(wave_.amplitude), w = std::abs(wave_.omega);
    return {everything(), {wave_.offset - a, wave_.offset + a}, {-a * w, a * w}};
  }

  /// F = -(amplitude / omega) cos(theta) + (amplitude / omega) cos(theta(t0)) + offset (t - t0), integrated term by
  /// term.
  Law integral(double t1) const override {
    if (std::abs(wave_.omega) < slow_omega) {
      return make_quadrature_integral(Law{std::make_shared<HarmonicIntegral>(wave_, t0_)}, t1);
    }
    const double a = wave_.amplitude / wave_.omega;
    const double level = a * std::cos(wave_.omega * (t0_ - wave_.start) + wave_.phase);
    const Law wave = make_wave({a, wave_.omega, wave_.phase - 0.5 * std::numbers::pi, level, wave_.start});
    const Law drift{std::make_shared<PolynomialPieces>(
        std::vector<PolynomialPieces::Knot>{}, std::vector<PolynomialPieces::Piece>{{t0_, 1.0, {0.0, wave_.offset}}})};
    return make_sum({wave.integral(t1), drift.integral(t1)});
  }

 private:
  Wave wave_;
  double t0_;
};

Law Harmonic::integral(double t0) const { return Law{std::make_shared<HarmonicIntegral>(wave_, t0)}; }

}  // namespace

Law make_wave(const Wave& wave) { return Law{std::make_shared<Harmonic>(wave)}; }

Law make_harmonic(double amplitude, double omega, double phase, double offset) {
  require_finite(amplitude, "the amplitude of a harmonic");
  require_finite(omega, "the angular frequency of a harmonic");
  require_finite(phase, "the phase of a harmonic");
  require_finite(offset, "the offset of a harmonic");
  if (amplitude == 0.0 || omega == 0.0) return make_constant(offset + amplitude * std::sin(phase));
  return make_wave({amplitude, omega, phase, offset, 0.0});
}

}  // namespace bough::laws
