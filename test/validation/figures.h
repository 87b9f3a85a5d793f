#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "scheme.h"

namespace shallow_sand {

/// One number that was measured, and what it should be.
struct Figure {
  Scheme scheme;
  std::string experiment;
  std::string quantity;
  std::string unit;
  double expected;
  double ours;
};

/// Prints what a test measured, asserts it, and keeps it for the validation page: scripts/plot_validation
/// reads the files that this leaves in the folder `validation` of where the tests run.
class FigureLog {
 public:
  explicit FigureLog(const std::string& name) : name_(name) {
    std::filesystem::create_directory("validation");
    file_.open("validation/" + name + ".figures");
  }

  /// Ours must lie within `tolerance`, which `reason` justifies, of a solution of the same equations.
  void near(const Figure& figure, double tolerance, const std::string& reason) {
    const bool met = std::abs(figure.ours - figure.expected) <= tolerance;
    write("model", figure, tolerance, reason, met ? "met" : "MISSED");
    EXPECT_TRUE(met) << figure.scheme.name << ", " << figure.experiment << ": " << figure.quantity;
  }

  /// A deviation that is known and told, and not asserted.
  void tell(const Figure& figure) { write("model", figure, 0.0, "", "told"); }

  /// What laboratories found, from `least` to `most`; nothing is asserted: the equations differ from sand,
  /// and simulations from the equations. @returns whether what was simulated lies between
  bool compare(const Figure& figure, double least, double most) {
    const bool within = figure.ours >= least && figure.ours <= most;
    char band[64];
    std::snprintf(band, sizeof band, "%.3g to %.3g", least, most);
    write("laboratory", figure, 0.0, band, within ? "within" : "outside");
    return within;
  }

  /// Errors that must fall with each spacing, and over all of them by an order of 1/2 at least: first-order
  /// schemes reach an order of 1/2 to 1 on solutions with corners and fronts.
  void converges(const Scheme& scheme, const std::string& experiment, const std::string& error,
                 const std::vector<double>& spacings, const std::vector<double>& errors) {
    for (std::size_t k = 0; k < errors.size(); ++k) {
      const double order = k == 0 ? NAN : orderOf(spacings[k - 1], errors[k - 1], spacings[k], errors[k]);
      std::printf("%-8s %-44s %-34s spacing %.5f m: %.4f, order %.2f\n", scheme.name, experiment.c_str(),
                  error.c_str(), spacings[k], errors[k], order);
      file_ << "convergence;" << scheme.name << ';' << experiment << ';' << error << ';' << spacings[k] << ';'
            << errors[k] << '\n';
      EXPECT_FALSE(order <= 0.0) << scheme.name << ", " << experiment << ": " << error << " at "
                                 << spacings[k];
    }
    EXPECT_GT(orderOf(spacings.front(), errors.front(), spacings.back(), errors.back()), 0.5)
        << scheme.name << ", " << experiment << ": " << error;
  }

  /// A curve of a plot, in validation/NAME_CURVE.csv.
  void curve(const std::string& curve, const std::string& header, const std::vector<double>& x,
             const std::vector<double>& y) const {
    std::ofstream file("validation/" + name_ + "_" + curve + ".csv");
    file << header << '\n';
    for (std::size_t k = 0; k < x.size(); ++k) file << x[k] << ',' << y[k] << '\n';
  }

 private:
  static double orderOf(double spacing, double error, double finer, double its_error) {
    return std::log(error / its_error) / std::log(spacing / finer);
  }

  void write(const std::string& kind, const Figure& figure, double tolerance, const std::string& remark,
             const std::string& verdict) {
    std::printf("%-8s %-44s %-34s expected %8.4f, ours %8.4f %s, tolerance %.4f: %s\n", figure.scheme.name,
                figure.experiment.c_str(), figure.quantity.c_str(), figure.expected, figure.ours,
                figure.unit.c_str(), tolerance, verdict.c_str());
    file_ << kind << ';' << figure.scheme.name << ';' << figure.experiment << ';' << figure.quantity << ';'
          << figure.unit << ';' << figure.expected << ';' << figure.ours << ';' << tolerance << ';' << remark
          << ';' << verdict << '\n';
  }

  std::string name_;
  std::ofstream file_;
};

}  // namespace shallow_sand
