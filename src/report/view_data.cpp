#include "view_data.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <unordered_map>

#include "between_frames.hpp"
#include "bough/io/columns.hpp"
#include "bough/io/json_text.hpp"
#include "bough/io/number_text.hpp"
#include "bough/motion/quaternion.hpp"
#include "bough/scene/joint_kinds.hpp"
#include "error_bands.hpp"
#include "packed.hpp"
#include "round_off.hpp"
#include "view_plots.hpp"

namespace bough::report {
namespace {

using Vec3 = motion::Vec3<double>;
using Mat3 = motion::Mat3<double>;
using records::MotionFrame;

template <class List>
std::string numbers(const List& list, int digits = 7) {
  std::string json = "[";
  for (const auto value : list) {
    if (json.size() > 1) json += ',';
    io::append_rounded(json, static_cast<double>(value), digits);
  }
  return json + "]";
}

template <class List, class Write>
std::string list_of(const List& list, const Write& write) {
  std::string json = "[";
  for (std::size_t k = 0; k < list.size(); ++k) json += (k > 0 ? "," : "") + write(k);
  return json + "]";
}

/// (x, y, z, w), w >= 0.
std::array<double, 4> quaternion_of(const double* axes) {
  Mat3 R;
  std::copy_n(axes, 9, R.m);
  const Vec3 r = motion::log_so3(R);
  const double angle = std::hypot(r[0], r[1], r[2]), s = angle > 1e-12 ? std::sin(0.5 * angle) / angle : 0.5;
  return {s * r[0], s * r[1], s * r[2], std::cos(0.5 * angle)};
}

/// Q of axes = Q axes_start.
std::array<double, 4> turn_of(const double* axes, const double* start) {
  double Q[9];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      Q[3 * i + j] =
          axes[3 * i] * start[3 * j] + axes[3 * i + 1] * start[3 * j + 1] + axes[3 * i + 2] * start[3 * j + 2];
  return quaternion_of(Q);
}

/// Moving frames, each different one once.
class Tracks {
 public:
  /// has_velocities: those of frames are the derivatives of the places. is_far: the motion is much longer than what
  /// moves, whose own lengths need more digits then.
  Tracks(const std::vector<const MotionFrame*>& frames, const std::array<double, 3>& origin, bool has_velocities,
         bool is_far)
      : frames_(frames), origin_(origin), has_velocities_(has_velocities), is_far_(is_far) {}

  /// place(frame): three coordinates; velocity(frame): the same; axes(frame): nine numbers, or null for what does not
  /// turn.
  template <class Place, class Velocity, class Axes>
  std::size_t add(const Place& place, const Velocity& velocity, const Axes& axes) {
    Series s;
    const double* x0 = place(*frames_.front());
    const double* R0 = axes(*frames_.front());
    std::vector<std::array<double, 3>> moves;
    std::array<double, 3> high{};
    for (const MotionFrame* f : frames_) {
      const double* x = place(*f);
      std::array<double, 3>& d = moves.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) {
        d[c] = std::isfinite(x[c]) && std::isfinite(x0[c]) ? x[c] - x0[c] : 0.0;
        s.low[c] = std::min(s.low[c], static_cast<float>(d[c]));
        high[c] = std::max(high[c], d[c]);
      }
      std::array<double, 4> q = R0 != nullptr ? turn_of(axes(*f), R0) : std::array<double, 4>{0, 0, 0, 1};
      if (!s.turns.empty() && dot_with_last(s.turns, q) < 0.0)
        for (double& component : q) component = -component;  // the same rotation, next to the last one
      for (const double component : q) s.turns.push_back(signed_16(component));
    }
    const double most = is_far_ ? 16777215.0 : 65535.0;
    for (std::size_t c = 0; c < 3; ++c) {
      s.start[c] = static_cast<float>(std::isfinite(x0[c]) ? x0[c] - origin_[c] : 0.0);
      s.step = std::max(s.step, static_cast<float>((high[c] - static_cast<double>(s.low[c])) / most));
    }
    for (const auto& d : moves)
      for (std::size_t c = 0; c < 3; ++c)
        s.moves.push_back(
            s.step > 0.0f ? whole((d[c] - static_cast<double>(s.low[c])) / static_cast<double>(s.step), most) : 0u);
    add_rates(place, velocity, s);
    return place_of(std::move(s));
  }

  void write(Arrays& arrays) const {
    std::vector<float> start, low, step, fastest;
    for (const Series& s : all_) {
      start.insert(start.end(), s.start.begin(), s.start.end());
      low.insert(low.end(), s.low.begin(), s.low.end());
      step.push_back(s.step);
      fastest.push_back(s.fastest);
    }
    const std::size_t n = frames_.size();
    std::vector<std::uint32_t> moves;
    std::vector<std::uint16_t> turns, rates;
    for (std::size_t f = 0; f < n; ++f)
      for (const Series& s : all_) {
        for (std::size_t c = 0; c < 3; ++c) {
          moves.push_back(s.moves[3 * f + c]);
          rates.push_back(s.rates[3 * f + c]);
        }
        for (std::size_t c = 0; c < 4; ++c) turns.push_back(s.turns[4 * f + c]);
      }
    arrays.add("start", "f32", start);
    arrays.add("low", "f32", low);
    arrays.add("step", "f32", step);
    arrays.add("fastest", "f32", fastest);
    if (is_far_)
      arrays.add_frames("displacement", moves, n);
    else
      arrays.add_frames("displacement", std::vector<std::uint16_t>(moves.begin(), moves.end()), n);
    arrays.add_frames("velocity", rates, n);
    arrays.add_frames("rotation", turns, n);
  }

 private:
  struct Series {
    std::array<float, 3> start{}, low{};
    float step = 0.0f, fastest = 0.0f;
    std::vector<std::uint32_t> moves;
    std::vector<std::uint16_t> turns, rates;
  };

  template <class Place, class Velocity>
  void add_rates(const Place& place, const Velocity& velocity, Series& s) const {
    std::vector<std::array<double, 3>> rates;
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      const double* v = velocity(*frames_[f]);
      rates.push_back(has_velocities_ ? std::array<double, 3>{v[0], v[1], v[2]} : slope_at(frames_, f, place));
      for (double& component : rates.back()) {
        if (!std::isfinite(component)) component = 0.0;
        s.fastest = std::max(s.fastest, static_cast<float>(std::abs(component)));
      }
    }
    for (const auto& rate : rates)
      for (const double component : rate)
        s.rates.push_back(s.fastest > 0.0f ? signed_16(component / static_cast<double>(s.fastest)) : std::uint16_t{0});
  }
  static double dot_with_last(const std::vector<std::uint16_t>& turns, const std::array<double, 4>& q) {
    double dot = 0.0;
    for (std::size_t c = 0; c < 4; ++c) dot += static_cast<std::int16_t>(turns[turns.size() - 4 + c]) * q[c];
    return dot;
  }

  static std::uint16_t signed_16(double q) {
    const double steps = std::isfinite(q) ? std::round(32767.0 * std::clamp(q, -1.0, 1.0)) : 0.0;
    return static_cast<std::uint16_t>(static_cast<std::int16_t>(steps));
  }
  static std::uint32_t whole(double steps, double most) {
    return std::isfinite(steps) ? static_cast<std::uint32_t>(std::clamp(std::round(steps), 0.0, most)) : 0u;
  }

  std::size_t place_of(Series s) {
    std::string key(reinterpret_cast<const char*>(s.start.data()), sizeof s.start);
    key.append(reinterpret_cast<const char*>(s.low.data()), sizeof s.low);
    key.append(reinterpret_cast<const char*>(s.moves.data()), s.moves.size() * sizeof(std::uint32_t));
    for (const auto* list : {&s.turns, &s.rates})
      key.append(reinterpret_cast<const char*>(list->data()), list->size() * sizeof(std::uint16_t));
    // Hashes alone are kept; series of one hash are compared.
    std::vector<std::size_t>& same = known_[std::hash<std::string>()(key)];
    for (const std::size_t k : same)
      if (all_[k].start == s.start && all_[k].low == s.low && all_[k].moves == s.moves && all_[k].turns == s.turns &&
          all_[k].rates == s.rates)
        return k;
    same.push_back(all_.size());
    all_.push_back(std::move(s));
    return all_.size() - 1;
  }

  const std::vector<const MotionFrame*>& frames_;
  std::array<double, 3> origin_;
  bool has_velocities_, is_far_;
  std::vector<Series> all_;
  std::unordered_map<std::size_t, std::vector<std::size_t>> known_;
};

struct Quantity {
  std::string name, label, unit;
  std::function<double(const records::CurvePoint&)> value;
};

double length_of(const double* v) { return std::hypot(v[0], v[1], v[2]); }

std::vector<Quantity> quantities() {
  std::vector<Quantity> all;
  const char* const forces[] = {"N", "Q2", "Q3", "T", "M2", "M3"};
  const char* const strains[] = {"e1", "g2", "g3", "k1", "k2", "k3"};
  for (int k = 0; k < 6; ++k)
    all.push_back({forces[k], std::string("section force ") + forces[k], k < 3 ? "N" : "N m",
                   [k](const records::CurvePoint& p) { return p.force[k]; }});
  all.push_back({"speed", "speed", "m/s", [](const records::CurvePoint& p) { return length_of(p.velocity); }});
  for (int k = 0; k < 6; ++k)
    all.push_back({strains[k], std::string("strain ") + strains[k], k < 3 ? "" : "1/m",
                   [k](const records::CurvePoint& p) { return p.strain[k]; }});
  return all;
}

/// Values of all points and frames in 255ths of their range; where all are equal, of a range around them.
struct Scaled {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  std::vector<double> values;
  void add(double v) {
    values.push_back(v);
    if (!std::isfinite(v)) return;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  void widen() {
    if (low > high) low = high = 0.0;
    const double least = 1e-9 * std::max(std::abs(low), std::abs(high));
    if (high - low <= least) {
      const double pad = std::max(least, 0.5 * std::abs(high) > 0.0 ? 0.1 * std::abs(high) : 1.0);
      low -= pad;
      high += pad;
    }
  }
  std::vector<std::uint8_t> bytes() const {
    std::vector<std::uint8_t> r;
    for (const double v : values)
      r.push_back(std::isfinite(v) ? static_cast<std::uint8_t>(std::round(255.0 * (v - low) / (high - low))) : 0);
    return r;
  }
};

struct Extent {
  Box box;
  void take(const double* x) {
    if (!std::isfinite(x[0]) || !std::isfinite(x[1]) || !std::isfinite(x[2])) return;
    for (std::size_t c = 0; c < 3; ++c) {
      if (box.empty) box.low[c] = box.high[c] = x[c];
      box.low[c] = std::min(box.low[c], x[c]);
      box.high[c] = std::max(box.high[c], x[c]);
    }
    box.empty = false;
  }
};

double radius_of(const scene::Mesh& mesh) {
  double r = 0.0;
  for (const auto& p : mesh.points) r = std::max(r, std::hypot(p[0], p[1], p[2]));
  return r;
}

/// The box of everything in all frames, bodies with their surfaces.
Box extent_of(const RunFiles& run) {
  Extent e;
  e.box = box_of(run.motion);
  for (const MotionFrame& f : run.motion)
    for (std::size_t k = 0; k < f.bodies.size(); ++k) {
      const int mesh = k < run.parts.bodies.size() ? run.parts.bodies[k] : -1;
      if (mesh < 0) continue;
      const double r = radius_of(run.parts.meshes[static_cast<std::size_t>(mesh)]);
      for (const double side : {-r, r}) {
        const double x[3] = {f.bodies[k].center[0] + side, f.bodies[k].center[1] + side, f.bodies[k].center[2] + side};
        e.take(x);
      }
    }
  return e.box;
}

/// Everything but the plots, of the frames given.
class MotionData {
 public:
  MotionData(const RunFiles& run, std::vector<const MotionFrame*> frames, bool with_strains)
      : run_(run), frames_(std::move(frames)), with_strains_(with_strains) {
    box_ = extent_of(run);
    for (std::size_t c = 0; c < 3; ++c) {
      middle_[c] = box_.empty ? 0.0 : 0.5 * (box_.low[c] + box_.high[c]);
      size_ = std::max(size_, box_.empty ? 0.0 : box_.high[c] - box_.low[c]);
    }
    // What does not move beyond round-off of where it is has no size of its own.
    const double least = 1e-9 * std::max({std::abs(middle_[0]), std::abs(middle_[1]), std::abs(middle_[2])});
    if (!(size_ > least) || size_ < 1e-12) size_ = 1.0;
  }

  std::string json(Arrays& arrays) {
    Tracks tracks(frames_, middle_, has_velocities(run_), is_far());
    std::string text = curves(tracks, arrays) + bodies(tracks, arrays) + others(tracks, arrays) + signals(arrays);
    tracks.write(arrays);
    std::vector<double> times;
    for (const MotionFrame* f : frames_) times.push_back(f->time);
    arrays.add("turn", "f32", turns());
    return "\"times\":" + numbers(times, 12) + ",\"largestTurn\":" + io::rounded_text(records::largest_turn, 6) +
           ",\"origin\":" + numbers(middle_) + ",\"middle\":[0,0,0],\"size\":" + io::rounded_text(size_, 6) +
           ",\"look\":\"" + look() + "\"," + text;
  }

 private:
  /// Whether the structure moves far against its own size.
  bool is_far() const {
    constexpr double far = 8.0;
    const Box now = box_of({*frames_.front()});
    double own = 0.0;
    for (std::size_t c = 0; c < 3; ++c) own = std::max(own, now.empty ? 0.0 : now.high[c] - now.low[c]);
    return size_ > far * own && own > 0.0;
  }

  /// How far parts turn from each frame to the next, with those that were left out between.
  std::vector<float> turns() const {
    std::vector<float> list;
    double sum = 0.0;
    std::size_t next = 0;
    for (const MotionFrame& f : run_.motion) {
      sum += f.turn;
      if (next == frames_.size() || frames_[next] != &f) continue;
      list.push_back(static_cast<float>(sum));
      sum = 0.0;
      ++next;
    }
    return list;
  }

  std::string look() const {
    switch (resolve_view(View::automatic, box_)) {
      case View::xy:
        return "z";
      case View::xz:
        return "y";
      case View::yz:
        return "x";
      default:
        return "iso";
    }
  }

  std::string curves(Tracks& tracks, Arrays& arrays) {
    const MotionFrame& start = *frames_.front();
    std::vector<std::uint32_t> point_track;
    std::vector<float> point_axes;
    std::string list = "[";
    for (std::size_t c = 0; c < start.curves.size(); ++c) {
      const records::Curve& curve = start.curves[c];
      const records::MotionParts::Curve part =
          c < run_.parts.curves.size() ? run_.parts.curves[c] : records::MotionParts::Curve{};
      list += (c > 0 ? ",{" : "{") + ("\"name\":" + io::json_string(curve.name)) +
              ",\"first\":" + std::to_string(point_track.size()) +
              ",\"points\":" + std::to_string(curve.points.size()) + ",\"outline\":" + std::to_string(part.outline) +
              ",\"subdomains\":" + numbers(part.subdomains) + "}";
      for (std::size_t k = 0; k < curve.points.size(); ++k) {
        point_track.push_back(
            static_cast<std::uint32_t>(tracks.add([&](const MotionFrame& f) { return f.curves[c].points[k].position; },
                                                  [&](const MotionFrame& f) { return f.curves[c].points[k].velocity; },
                                                  [&](const MotionFrame& f) { return f.curves[c].points[k].axes; })));
        for (const double q : quaternion_of(curve.points[k].axes)) point_axes.push_back(static_cast<float>(q));
      }
    }
    arrays.add("pointTrack", "u32", point_track);
    arrays.add("pointAxes", "f32", point_axes);
    std::string found = "[";
    for (const Quantity& q : quantities()) {
      if (point_track.empty() && q.name != "speed") continue;
      if (q.unit != "N" && q.unit != "N m" && q.name != "speed" && !with_strains_) continue;
      Scaled of_points, of_bodies;
      for (const MotionFrame* f : frames_) {
        for (const records::Curve& curve : f->curves)
          for (const records::CurvePoint& p : curve.points) of_points.add(q.value(p));
        if (q.name == "speed")
          for (const records::BodyPose& b : f->bodies) of_bodies.add(length_of(b.velocity));
      }
      if (q.name == "speed") {
        of_points.low = of_bodies.low = std::min({0.0, of_points.low, of_bodies.low});
        of_points.high = of_bodies.high = std::max(of_points.high, of_bodies.high);
        of_bodies.widen();
        if (!of_bodies.values.empty()) arrays.add_frames("body.speed", of_bodies.bytes(), frames_.size());
      }
      of_points.widen();
      if (!of_points.values.empty()) arrays.add_frames("q." + q.name, of_points.bytes(), frames_.size());
      found += (found.size() > 1 ? ",{" : "{") + ("\"name\":\"" + q.name) + "\",\"label\":\"" + q.label +
               "\",\"unit\":\"" + q.unit + "\",\"low\":" + io::rounded_text(of_points.low, 6) +
               ",\"high\":" + io::rounded_text(of_points.high, 6) + "}";
    }
    const bool has_domains = std::any_of(run_.parts.curves.begin(), run_.parts.curves.end(),
                                         [](const auto& c) { return !c.subdomains.empty(); });
    if (has_domains)
      found += std::string(found.size() > 1 ? "," : "") +
               R"({"name":"sub-domain","label":"sub-domain of the solver","unit":"","low":0,"high":1})";
    return "\"numPoints\":" + std::to_string(point_track.size()) + ",\"curves\":" + list + "],\"quantities\":" + found +
           "]";
  }

  std::string bodies(Tracks& tracks, Arrays&) {
    const MotionFrame& start = *frames_.front();
    return ",\"bodies\":" + list_of(start.bodies, [&](std::size_t k) {
             const records::BodyPose& b = start.bodies[k];
             std::vector<double> arms;
             for (const auto& a : b.attachments)
               for (std::size_t c = 0; c < 3; ++c) arms.push_back(a[c] - b.center[c]);
             const std::size_t track = tracks.add([&](const MotionFrame& f) { return f.bodies[k].center; },
                                                  [&](const MotionFrame& f) { return f.bodies[k].velocity; },
                                                  [&](const MotionFrame& f) { return f.bodies[k].axes; });
             return "{\"name\":" + io::json_string(b.name) + ",\"track\":" + std::to_string(track) +
                    ",\"axes\":" + numbers(quaternion_of(b.axes)) +
                    ",\"mesh\":" + std::to_string(k < run_.parts.bodies.size() ? run_.parts.bodies[k] : -1) +
                    ",\"arms\":" + numbers(arms) + "}";
           });
  }

  /// How joints are drawn, by kind.
  static std::string glyphs() {
    std::string json = "{";
    for (const scene::JointType& type : scene::joint_types())
      json += (json.size() > 1 ? "," : "") + io::json_string(type.name) +
              ":{\"axis\":" + (type.axes == scene::JointAxes::none ? "false" : "true") + ",\"prisms\":" +
              list_of(type.glyph,
                      [&](std::size_t k) {
                        const scene::GlyphPrism& p = type.glyph[k];
                        return numbers(std::array<double, 3>{static_cast<double>(p.sides), p.radius, p.half_length});
                      }) +
              "}";
    return json + "}";
  }

  std::string others(Tracks& tracks, Arrays& arrays) {
    const MotionFrame& start = *frames_.front();
    const auto still = [](const MotionFrame&) -> const double* { return nullptr; };
    std::string text =
        ",\"links\":" + list_of(start.links, [&](std::size_t k) {
          const records::Link& l = start.links[k];
          const std::size_t first = tracks.add([&](const MotionFrame& f) { return f.links[k].first; },
                                               [&](const MotionFrame& f) { return f.links[k].first_velocity; },
                                               [&](const MotionFrame& f) { return f.links[k].axes; });
          const std::size_t second =
              tracks.add([&](const MotionFrame& f) { return f.links[k].second; },
                         [&](const MotionFrame& f) { return f.links[k].second_velocity; }, still);
          return "{\"name\":" + io::json_string(l.name) +
                 ",\"kind\":" + io::json_string(k < run_.parts.links.size() ? run_.parts.links[k].kind : "") +
                 ",\"first\":" + std::to_string(first) + ",\"second\":" + std::to_string(second) +
                 ",\"axes\":" + numbers(quaternion_of(l.axes)) + "}";
        });
    text += ",\"glyphs\":" + glyphs();
    text += ",\"frames\":" + list_of(start.frames, [&](std::size_t k) {
              const records::FramePose& p = start.frames[k];
              const std::size_t track = tracks.add([&](const MotionFrame& f) { return f.frames[k].position; },
                                                   [&](const MotionFrame& f) { return f.frames[k].velocity; },
                                                   [&](const MotionFrame& f) { return f.frames[k].axes; });
              return "{\"name\":" + io::json_string(p.name) + ",\"track\":" + std::to_string(track) +
                     ",\"axes\":" + numbers(quaternion_of(p.axes)) + "}";
            });
    std::vector<float> force, moment;
    for (const MotionFrame* f : frames_)
      for (const records::Arrow& a : f->arrows) {
        for (const double v : a.force) force.push_back(static_cast<float>(v));
        for (const double v : a.moment) moment.push_back(static_cast<float>(v));
      }
    arrays.add("force", "f32", force);
    arrays.add("moment", "f32", moment);
    text += ",\"arrows\":" + list_of(start.arrows, [&](std::size_t k) {
              const std::size_t track = tracks.add([&](const MotionFrame& f) { return f.arrows[k].position; },
                                                   [&](const MotionFrame& f) { return f.arrows[k].velocity; }, still);
              return "{\"name\":" + io::json_string(start.arrows[k].name) + ",\"kind\":\"" +
                     (start.arrows[k].is_per_length ? "line load" : "load") + "\",\"track\":" + std::to_string(track) +
                     "}";
            });
    const auto flat = [](const auto& points) {
      std::vector<double> values;
      for (const auto& p : points)
        for (const auto v : p) values.push_back(static_cast<double>(v));
      return numbers(values);
    };
    text += ",\"outlines\":" + list_of(run_.parts.outlines, [&](std::size_t k) {
              const auto& loops = run_.parts.outlines[k].loops;
              return list_of(loops, [&](std::size_t l) { return flat(loops[l]); });
            });
    return text + ",\"meshes\":" + list_of(run_.parts.meshes, [&](std::size_t k) {
             return "{\"points\":" + flat(run_.parts.meshes[k].points) +
                    ",\"triangles\":" + flat(run_.parts.meshes[k].triangles) + "}";
           });
  }

  std::string signals(Arrays& arrays) const {
    const std::size_t count = num_signals_shown(run_);
    std::vector<float> values;
    for (std::size_t k = 0; k < count; ++k)
      for (const MotionFrame* f : frames_) values.push_back(static_cast<float>(f->signals[k].value));
    arrays.add("signals", "f32", values);
    return ",\"signals\":" + list_of(std::vector<int>(count), [&](std::size_t k) {
             return "{\"name\":" + io::json_string(frames_.front()->signals[k].name) + "}";
           });
  }

  const RunFiles& run_;
  std::vector<const MotionFrame*> frames_;
  bool with_strains_;
  Box box_;
  std::array<double, 3> middle_{};
  double size_ = 0.0;
};

}  // namespace

std::size_t num_signals_shown(const RunFiles& run) {
  constexpr std::size_t most = 200;
  return run.motion.empty() ? 0 : std::min(most, run.motion.front().signals.size());
}

std::string view_data(const RunFiles& run, std::size_t most_bytes) {
  std::vector<const MotionFrame*> frames;
  for (const MotionFrame& f : run.motion) frames.push_back(&f);
  const std::vector<std::string> modes = mode_labels(run);
  const std::string head = "{\"name\":" + io::json_string(run.name) +
                           ",\"isStatic\":" + (is_static(run) || is_of_modes(run) ? "true" : "false") +
                           ",\"timeLabel\":\"" + std::string(time_label(run)) +
                           "\",\"modes\":" + list_of(modes, [&](std::size_t k) { return io::json_string(modes[k]); }) +
                           ",";
  constexpr std::size_t many_points = 8000;
  std::size_t num_points = 0;
  if (!frames.empty())
    for (const records::Curve& c : frames.front()->curves) num_points += c.points.size();
  for (bool with_strains = num_points <= many_points;; with_strains = false) {
    Arrays arrays;
    const std::string plots = plot_data(run.history, round_off_of(run), error_bands(run.history, run.errors), arrays);
    const std::string motion =
        frames.empty()
            ? "\"times\":[],\"curves\":[],\"bodies\":[],\"links\":[],\"frames\":[],\"arrows\":[],\"signals\":[]"
            : MotionData(run, frames, with_strains).json(arrays);
    const std::string packed = deflated(arrays.bytes());
    if (packed.size() <= most_bytes || frames.size() <= 2)
      return head + motion + ",\"plots\":" + plots + ",\"arrays\":" + arrays.list() + ",\"packed\":\"" +
             base64(packed) + "\"}";
    std::vector<const MotionFrame*> fewer;
    for (std::size_t k = 0; k < frames.size(); k += 2) fewer.push_back(frames[k]);
    if (fewer.back() != frames.back()) fewer.push_back(frames.back());
    frames = fewer;
  }
}

}  // namespace bough::report
