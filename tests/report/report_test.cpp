#include <cmath>
#include <limits>
#include <regex>

#include "../../src/report/between_frames.hpp"
#include "../../src/report/error_bands.hpp"
#include "../../src/report/packed.hpp"
#include "../../src/report/pixel_text.hpp"
#include "../../src/report/round_off.hpp"
#include "../../src/report/svg_text.hpp"
#include "bough/io/atomic_file.hpp"
#include "bough/io/run_directory.hpp"
#include "bough/report/page.hpp"
#include "bough/report/plot.hpp"
#include "bough/report/raster.hpp"
#include "io/write_samples.hpp"

namespace bough::report {
namespace {

std::vector<records::MotionFrame> sample_motion(int num_frames = 30) {
  std::vector<records::MotionFrame> frames;
  for (int k = 0; k < num_frames; ++k) frames.push_back(io::sample_frame(0.2 * k, 20));
  return frames;
}

std::size_t count_of(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
  return count;
}

TEST(Pixel, of_what_no_page_holds_is_still_a_coordinate) {
  EXPECT_EQ(pixel(12.3456), "12.35");
  EXPECT_EQ(pixel(-0.025), "-0.05");
  for (const double far : {1e6, 1e20, 1e300, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(pixel(far), "1000000");
    EXPECT_EQ(pixel(-far), "-1000000");
  }
  EXPECT_EQ(pixel(std::nan("")), "-1000000");
}

TEST(Projection, of_every_view_is_orthonormal) {
  for (const View view : {View::xy, View::xz, View::yz, View::iso}) {
    const Projection p = projection_of(view);
    double rr = 0.0, uu = 0.0, ru = 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
      rr += p.right[k] * p.right[k];
      uu += p.up[k] * p.up[k];
      ru += p.right[k] * p.up[k];
    }
    EXPECT_NEAR(rr, 1.0, 1e-15);
    EXPECT_NEAR(uu, 1.0, 1e-15);
    EXPECT_NEAR(ru, 0.0, 1e-15);
  }
}

TEST(Projection, isometric_shortens_the_three_axes_alike) {
  const Projection p = projection_of(View::iso);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(std::hypot(p.right[k], p.up[k]), std::sqrt(2.0 / 3.0), 1e-15);
}

TEST(Projection, a_planar_motion_is_drawn_in_its_plane) {
  const auto box = [](double x, double y, double z) { return Box{{0.0, 0.0, 0.0}, {x, y, z}, false}; };
  EXPECT_EQ(resolve_view(View::automatic, box(2, 1, 0)), View::xy);
  EXPECT_EQ(resolve_view(View::automatic, box(2, 0.01, 1)), View::xz);
  EXPECT_EQ(resolve_view(View::automatic, box(0, 1, 1)), View::yz);
  EXPECT_EQ(resolve_view(View::automatic, box(1, 1, 1)), View::iso);
  EXPECT_EQ(resolve_view(View::automatic, box(0, 0, 1)), View::xz);
  EXPECT_EQ(resolve_view(View::yz, box(2, 1, 0)), View::yz) << "a choice is kept";
}

/// Coordinates of the first and last point of the first path of a picture.
std::array<double, 4> ends_of(const std::string& path) {
  const std::regex number(R"([ML](-?[0-9.]+) (-?[0-9.]+))");
  std::array<double, 4> ends{};
  bool first = true;
  for (std::sregex_iterator it(path.begin(), path.end(), number), end; it != end; ++it) {
    if (first) ends = {std::stod((*it)[1]), std::stod((*it)[2]), 0.0, 0.0};
    first = false;
    ends[2] = std::stod((*it)[1]);
    ends[3] = std::stod((*it)[2]);
  }
  return ends;
}

/// A rotor whose hub flies along y, as pictures after every `turn` radians: a blade from 0.2 to 1 m about the hub, a body
/// at its tip held from the hub, a link and a load there.
std::vector<records::MotionFrame> rotor_motion(double turn, double flight, int num_frames = 20) {
  std::vector<records::MotionFrame> frames;
  for (int k = 0; k < num_frames; ++k) {
    records::MotionFrame f;
    f.time = 0.1 * k;
    f.turn = k > 0 ? turn : 0.0;
    const double angle = turn * k, spin = turn / 0.1, c = std::cos(angle), s = std::sin(angle), y = flight * f.time;
    const auto put = [&](double r, double* x, double* v) {
      const double place[3] = {r * c, y + r * s, 0.5}, velocity[3] = {-r * spin * s, flight + r * spin * c, 0.0};
      std::copy_n(place, 3, x);
      std::copy_n(velocity, 3, v);
    };
    const double axes[9] = {c, -s, 0, s, c, 0, 0, 0, 1};
    records::Curve blade{"blade", {}};
    for (const double r : {0.2, 0.4, 0.6, 0.8, 1.0}) {
      records::CurvePoint& p = blade.points.emplace_back();
      put(r, p.position, p.velocity);
      std::copy_n(axes, 9, p.axes);
    }
    records::BodyPose tip{"tip", {}, {}, {}};
    put(1.0, tip.center, tip.velocity);
    std::copy_n(tip.center, 3, tip.position);
    std::copy_n(axes, 9, tip.axes);
    tip.attachments = {{0.0, y, 0.5}};
    records::Link rod{"rod", {}, {}};
    put(0.0, rod.first, rod.first_velocity);
    put(1.0, rod.second, rod.second_velocity);
    records::Arrow load{"load", {}, {}, {}};
    put(1.0, load.position, load.velocity);
    f.curves = {blade};
    f.bodies = {tip};
    f.links = {rod};
    f.arrows = {load};
    frames.push_back(std::move(f));
  }
  return frames;
}
double distance(const double* a, const double* b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

TEST(BetweenFrames, what_turns_keeps_its_length_and_stays_where_it_belongs) {
  for (const double turn : {0.25, 0.5, 0.75})
    for (const double flight : {0.0, 30.0}) {
      const std::vector<records::MotionFrame> frames = rotor_motion(turn, flight);
      for (double t = 0.0; t <= 1.9; t += 0.00713) {
        const records::MotionFrame f = frame_at(frames, t, true);
        SCOPED_TRACE(t);
        const std::vector<records::CurvePoint>& blade = f.curves[0].points;
        EXPECT_NEAR(distance(blade.front().position, blade.back().position), 0.8, 1e-3 * 0.8);
        EXPECT_NEAR(distance(f.links[0].first, f.links[0].second), 1.0, 1e-3);
        EXPECT_NEAR(distance(f.bodies[0].center, f.bodies[0].attachments[0].data()), 1.0, 1e-12) << "a body is rigid";
        EXPECT_LT(distance(f.bodies[0].center, blade.back().position), 1e-9);
        EXPECT_LT(distance(f.arrows[0].position, blade.back().position), 1e-9);
        const double angle = turn * t / 0.1, place[3] = {std::cos(angle), flight * t + std::sin(angle), 0.5};
        EXPECT_LT(distance(blade.back().position, place), 1e-3);
        EXPECT_NEAR(blade.back().axes[0], std::cos(angle), 1e-6);
      }
    }
}

TEST(BetweenFrames, after_too_large_a_turn_the_nearer_frame_stands) {
  const std::vector<records::MotionFrame> frames = rotor_motion(2.0, 0.0);
  for (const auto& [time, nearest] : {std::pair{0.34, 3}, std::pair{0.36, 4}}) {
    const records::MotionFrame f = frame_at(frames, time, true);
    for (std::size_t k = 0; k < 5; ++k)
      EXPECT_EQ(distance(f.curves[0].points[k].position,
                         frames[static_cast<std::size_t>(nearest)].curves[0].points[k].position),
                0.0);
  }
}

// Statics has no velocities: parabolas through neighbours.
TEST(BetweenFrames, of_statics_follow_the_curve_of_its_load_steps) {
  std::vector<records::MotionFrame> frames = rotor_motion(0.4, 0.0);
  for (records::MotionFrame& f : frames)
    for (records::CurvePoint& p : f.curves[0].points) std::fill_n(p.velocity, 3, 0.0);
  for (double t = 0.1; t <= 1.8; t += 0.0093) {  // the first and the last step are half as well known
    const std::vector<records::CurvePoint> blade = frame_at(frames, t, false).curves[0].points;
    EXPECT_NEAR(distance(blade.front().position, blade.back().position), 0.8, 6e-3) << t;
  }
}

TEST(Picture, has_equal_axes_whatever_the_shape) {
  for (const double height : {0.01, 1.0, 100.0}) {
    records::MotionFrame frame;
    const auto curve = [&](double x, double y) {
      records::Curve c;
      c.points.resize(2);
      c.points[1].position[0] = x;
      c.points[1].position[1] = y;
      return c;
    };
    frame.curves = {curve(1.0, 0.0), curve(0.0, height)};
    const Picture picture = make_picture({frame}, {.view = View::xy});
    const std::string& path = picture.positions.at(0).beams;
    const std::size_t second = path.find('M', 1);
    const auto a = ends_of(path.substr(0, second)), b = ends_of(path.substr(second));
    const double per_x = a[2] - a[0], per_y = (b[1] - b[3]) / height;
    EXPECT_NEAR(per_y, per_x, 0.1 / std::min(height, 1.0)) << "a twentieth of a pixel at each end";
    EXPECT_GT(per_x * std::max(1.0, height), 100.0) << "the drawing fills the sheet";
  }
}

TEST(Picture, lays_the_asked_number_of_positions_over_each_other) {
  const std::vector<records::MotionFrame> frames = sample_motion();
  for (const int wanted : {1, 2, 5, 9}) {
    const Picture picture = make_picture(frames, {.num_positions = wanted});
    const std::string positions = picture.svg.substr(0, picture.svg.find("</g>"));
    EXPECT_EQ(count_of(positions, "class=\"beams "), static_cast<std::size_t>(wanted));
  }
  EXPECT_EQ(make_picture(frames, {}).positions.size(), 9u);
}

TEST(Picture, points_that_are_not_finite_are_left_out) {
  std::vector<records::MotionFrame> frames = sample_motion(3);
  frames[1].curves[0].points[3].position[0] = std::numeric_limits<double>::quiet_NaN();
  frames[2].bodies[0].center[1] = std::numeric_limits<double>::infinity();
  const Picture picture = make_picture(frames, {});
  for (const char* word : {"nan", "inf"})
    EXPECT_EQ(picture.svg.find(std::string(word) + " "), std::string::npos) << word;
  for (const Picture::Paths& paths : picture.positions)
    for (const std::string* path : {&paths.beams, &paths.bodies, &paths.springs, &paths.joints})
      EXPECT_EQ(path->find_first_not_of("MLh0123456789.- "), std::string::npos) << *path;
}

TEST(Picture, of_a_single_point_that_stays_is_still_a_picture) {
  records::MotionFrame frame;
  frame.bodies.push_back({"ball", {1e6, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}, {1e6, 0, 0}});
  const Picture picture = make_picture({frame, frame}, {});
  EXPECT_EQ(picture.positions[0].joints.find_first_not_of("Mh0123456789.- "), std::string::npos)
      << picture.positions[0].joints;
}

TEST(Plot, ticks_are_round_and_inside) {
  for (const auto& [low, high] : {std::pair{0.0, 1.0}, {-3.7, 12.2}, {1e-9, 2e-9}, {1e6, 1e6 + 3.0}, {-0.001, 0.0}}) {
    const std::vector<double> ticks = round_ticks(low, high, 5);
    ASSERT_GE(ticks.size(), 2u);
    EXPECT_LE(ticks.size(), 7u);
    const double step = ticks[1] - ticks[0], slack = 1e-6 * step;
    EXPECT_GE(ticks.front(), low - slack);
    EXPECT_LE(ticks.back(), high + slack);
    const double leading = step / std::pow(10.0, std::floor(std::log10(step) + 1e-6));
    EXPECT_TRUE(std::abs(leading - 1.0) < 1e-3 || std::abs(leading - 2.0) < 1e-3 || std::abs(leading - 5.0) < 1e-3)
        << step;
  }
}

TEST(Plot, labels_of_neighbours_differ) {
  using Labels = std::vector<std::string>;
  EXPECT_EQ(tick_labels({0.0, 0.5, 1.0}), (Labels{"0", "0.5", "1"}));
  EXPECT_EQ(tick_labels({0.2499999, 0.25, 0.2500001, 0.2500002}), (Labels{"-1e-07", "0.25", "+1e-07", "+2e-07"}));
  EXPECT_EQ(tick_labels({4.0, 4.0 + 1e-12}), (Labels{"4", "+1e-12"}));
}

TEST(Plot, of_many_rows_is_small_and_keeps_its_peak) {
  io::History history;
  history.header.columns = {"a"};
  for (int k = 0; k < 200000; ++k)
    history.rows.push_back({1e-3 * k, 1e-3, 1, {k == 123457 ? 50.0 : std::sin(1e-3 * k)}});
  const Plot plot = make_plot(history, "a", {0}, "time");
  EXPECT_LT(plot.svg.size(), 60'000u);
  std::vector<double> heights;
  const std::regex number(R"([ML]-?[0-9.]+ (-?[0-9.]+))");
  for (std::sregex_iterator it(plot.svg.begin(), plot.svg.end(), number), end; it != end; ++it)
    heights.push_back(std::stod((*it)[1]));
  std::sort(heights.begin(), heights.end());
  EXPECT_LT(heights[0], heights[10] - 50.0) << "one point stands far above all others";
}

TEST(Plot, measured_errors_are_lines_above_and_below_the_curve) {
  io::History history, errors;
  history.header.columns = {"a"};
  errors.header.columns = {"a.extrapolated", "a.error_in_time", "a.error_of_mesh"};
  for (int k = 0; k < 10; ++k) {
    history.rows.push_back({1.0 * k, 1.0, 1, {1.0 * k}});
    errors.rows.push_back({1.0 * k, 1.0, 1, {1.0 * k, -0.5, k < 5 ? std::nan("") : 0.25}});
  }
  const std::vector<std::vector<double>> bands = error_bands(history, errors);
  ASSERT_EQ(bands.size(), 1u);
  EXPECT_EQ(bands[0].front(), 0.5);
  EXPECT_EQ(bands[0].back(), 0.75);
  const std::string with = make_plot(history, "a", {0}, "time", 0.0, bands).svg;
  EXPECT_EQ(make_plot(history, "a", {0}, "time").svg.find("class=\"bound"), std::string::npos);
  const std::size_t first = with.find("class=\"bound");
  ASSERT_NE(first, std::string::npos);
  EXPECT_NE(with.find("class=\"bound", first + 1), std::string::npos);
  errors.rows.pop_back();
  EXPECT_TRUE(error_bands(history, errors).empty()) << "rows of another run";
}

TEST(Plot, values_that_are_not_finite_leave_a_gap) {
  io::History history;
  history.header.columns = {"a"};
  for (int k = 0; k < 10; ++k) history.rows.push_back({1.0 * k, 1.0, 1, {k == 5 ? std::nan("") : 1.0 * k}});
  const Plot plot = make_plot(history, "a", {0}, "time");
  EXPECT_EQ(plot.svg.find("nan"), std::string::npos);
  const std::size_t curve = plot.svg.find("class=\"curve");
  EXPECT_EQ(count_of(plot.svg.substr(curve, plot.svg.find("/>", curve) - curve), "M"), 2u);
}

TEST(Plot, of_nothing_but_round_off_says_so_and_has_no_scale) {
  RunFiles run;
  run.history.header.columns = {"wall.Fx", "wall.Mx", "hinge.M"};
  run.history.header.about = {{"N", "joint_reaction", "wall"}, {"N m", "joint_reaction", "wall"}, {"N m", "", ""}};
  records::MotionFrame frame;
  frame.curves.emplace_back().points.resize(2);
  frame.curves[0].points[1].position[0] = 3.0;
  run.motion = {frame};
  for (int k = 0; k < 10; ++k) run.history.rows.push_back({1.0 * k, 1.0, 1, {2.0 * k, 5e-37 * k, 1e-12 * k}});
  const std::vector<double> least = round_off_of(run);
  ASSERT_EQ(least.size(), 3u);
  EXPECT_DOUBLE_EQ(least[0], 18e-14);
  EXPECT_DOUBLE_EQ(least[1], 54e-14) << "the largest force over the size of the structure";
  const std::string zero = make_plot(run.history, "moment", {1}, "time", least[1]).svg;
  EXPECT_NE(zero.find(round_off_words), std::string::npos);
  EXPECT_EQ(zero.find("e-3"), std::string::npos) << "no scale of round-off";
  EXPECT_EQ(make_plot(run.history, "force", {0}, "time", least[0]).svg.find(round_off_words), std::string::npos);
  EXPECT_EQ(make_plot(run.history, "small", {2}, "time", least[2]).svg.find(round_off_words), std::string::npos)
      << "what is above it is shown, small as it is";
}

class Page : public testing::Test {
 protected:
  RunFiles written(bool with_motion) {
    io::RunDirectory run(scratch_ / "run", "1.0");
    records::Summary summary = io::sample_summary();
    summary.title = "<b>&\"";
    run.begin(summary.header);
    for (int k = 0; k < 5; ++k) run.row({0.1 * k, 0.1, 2, {1.0, 0.5 * k, 3.5}});
    if (with_motion)
      for (int k = 0; k < 5; ++k) run.motion(io::sample_frame(0.1 * k));
    run.end(summary);
    return read_run(scratch_ / "run");
  }
  io::ScratchDirectory scratch_;
};

/// Without what the script says: its text names formats and draws elements of its own.
std::string without_script(const std::string& html) {
  const std::size_t begin = html.find("</script>\n<script>");
  return html.substr(0, begin);
}

TEST_F(Page, of_a_path_whose_load_factor_turns_back_counts_steps) {
  RunFiles run = written(true);
  EXPECT_FALSE(turns_back(run)) << "time never does";
  run.summary->options.emplace_back("/analysis/kind", "static");
  EXPECT_FALSE(turns_back(run));
  const double factors[] = {0.0, 0.3, 0.2, 0.1, 0.1};
  ASSERT_EQ(run.history.rows.size(), 5u);
  ASSERT_EQ(run.motion.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) run.history.rows[k].time = run.motion[k].time = factors[k];
  run.motion.erase(run.motion.begin() + 1);  // a picture may be left out
  ASSERT_TRUE(turns_back(run));
  const RunFiles steps = by_step(run);
  EXPECT_EQ(steps.history.header.columns.front(), "load factor");
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(steps.history.rows[k].time, static_cast<double>(k));
    EXPECT_EQ(steps.history.rows[k].values.front(), factors[k]);
    EXPECT_EQ(steps.history.rows[k].values.size(), run.history.rows[k].values.size() + 1);
  }
  const double numbers[] = {0.0, 2.0, 3.0, 4.0};
  for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(steps.motion[k].time, numbers[k]);
  const std::string html = page_html(run, {});
  EXPECT_NE(html.find("\"timeLabel\":\"step\""), std::string::npos);
  EXPECT_NE(html.find("position at step"), std::string::npos);
  EXPECT_NE(html.find("Permission is hereby granted, free of charge"), std::string::npos) << "the licence of three.js";
}

TEST_F(Page, lists_signals_with_units_and_their_values_at_the_end) {
  RunFiles run = written(true);
  EXPECT_EQ(page_html(run, {}).find("id=\"signals\""), std::string::npos) << "of a run that has some";
  run.parts.signal_units = {"N m", "<Pa>"};
  for (std::size_t k = 0; k < run.motion.size(); ++k) {
    run.motion[k].signals = {{"torque", 0.5 * static_cast<double>(k)}, {"pressure", -1.25}};
    for (int more = 0; more < 205; ++more) run.motion[k].signals.push_back({"more" + std::to_string(more), 7.0});
  }
  RunFiles other = run;
  for (records::MotionFrame& frame : other.motion) frame.signals = {{"pressure", 3.5}};
  const std::string html = without_script(page_html(run, {}));
  EXPECT_NE(html.find("<p><span>torque [N m]</span> <output>2</output></p>"), std::string::npos);
  EXPECT_NE(html.find("<p><span>pressure [&lt;Pa&gt;]</span> <output>-1.25</output></p>"), std::string::npos);
  EXPECT_EQ(count_of(html, "<output>"), 200u);
  EXPECT_NE(html.find("7 more signals are in motion.bin"), std::string::npos);
  const std::string both = without_script(page_html(run, {}, &other));
  EXPECT_NE(both.find("<span>torque [N m]</span> <output>2</output> <output>–</output>"), std::string::npos);
  EXPECT_NE(both.find("</span> <output>-1.25</output> <output>3.5</output>"), std::string::npos);
}

TEST_F(Page, stands_alone_and_asks_for_nothing_from_elsewhere) {
  const std::string html = without_script(page_html(written(true), {}));
  EXPECT_EQ(count_of(html, "http://"), count_of(html, "http://www.w3.org/2000/svg")) << "names of formats only";
  for (const char* word : {"https://", "src=", "href=", "url(", "@import"}) EXPECT_EQ(count_of(html, word), 0u) << word;
  EXPECT_EQ(count_of(html, "<svg"), 1u + 2u) << "the motion, tip and energy";
}

TEST_F(Page, lets_in_its_own_script_alone_and_is_the_same_for_the_same_run) {
  const RunFiles files = written(true);
  const std::string html = page_html(files, {});
  const std::size_t begin = html.rfind("<script>") + 8, end = html.rfind("</script>");
  const std::string hash = base64(sha256(html.substr(begin, end - begin)));
  EXPECT_NE(html.find("default-src 'none'; style-src 'unsafe-inline'; script-src 'sha256-" + hash + "'\""),
            std::string::npos);
  EXPECT_EQ(count_of(html, "<script"), 2u);
  EXPECT_EQ(page_html(files, {}), html);
}

TEST_F(Page, of_two_runs_holds_both) {
  const RunFiles files = written(true);
  const std::string html = page_html(files, {}, &files);
  EXPECT_EQ(count_of(html, "\"packed\":"), 2u + count_of(html.substr(html.rfind("<script>")), "\"packed\":"));
}

TEST_F(Page, pictures_are_the_same_bytes_for_the_same_instant_and_others_for_another) {
  const RunFiles files = written(true);
  const std::string png = picture_png(files, 0.2);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_EQ(picture_png(files, 0.2), png);
  EXPECT_NE(picture_png(files, 0.4), png);
  for (const std::string_view known : {"0123456789.-+e", "t = s", "load factor", "m", "xyz"})
    for (const char c : known) EXPECT_EQ(dots_of(std::string_view(&c, 1)).empty(), c == ' ') << c;
  EXPECT_EQ(dots_of("m 1").back()[0], 2 * letter_step + 3) << "letters stand side by side";
}

TEST(Packed, texts_have_the_published_hashes_and_codes) {
  const auto hex = [](const std::string& bytes) {
    std::string text;
    for (const char c : bytes)
      for (const int shift : {4, 0}) text += "0123456789abcdef"[static_cast<unsigned char>(c) >> shift & 15];
    return text;
  };
  // FIPS 180-4, examples of the standard.
  EXPECT_EQ(hex(sha256("abc")), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hex(sha256("")), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hex(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq")),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  // RFC 4648, section 10.
  for (const auto& [text, code] :
       {std::pair{"", ""}, {"f", "Zg=="}, {"fo", "Zm8="}, {"foo", "Zm9v"}, {"foobar", "Zm9vYmFy"}})
    EXPECT_EQ(base64(text), code);
}

TEST_F(Page, escapes_what_names_may_hold) {
  const std::string html = without_script(page_html(written(true), {}));
  EXPECT_EQ(count_of(html, "<b>"), 0u);
  EXPECT_NE(html.find("&lt;b&gt;&amp;&quot;"), std::string::npos);
}

TEST_F(Page, without_motion_says_what_to_do) {
  const std::string html = without_script(page_html(written(false), {}));
  EXPECT_NE(html.find("--set /output/motion=true"), std::string::npos);
  EXPECT_EQ(count_of(html, "<svg"), 2u);
}

TEST_F(Page, of_a_run_that_did_not_end_says_so) {
  RunFiles files = written(true);
  files.summary.reset();
  EXPECT_NE(page_html(files, {}).find("did not end"), std::string::npos);
}

TEST_F(Page, a_directory_without_a_history_is_refused) {
  EXPECT_THROW((void)read_run(scratch_ / "none"), std::runtime_error);
}

}  // namespace
}  // namespace bough::report
