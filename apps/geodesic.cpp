// nullcone-geodesic: light rays and falling particles, by numbers and as a picture.
#include <iostream>

#include "apps/geodesic_connect.h"
#include "apps/geodesic_picture.h"
#include "apps/geodesic_report.h"
#include "apps/tool.h"

int main(int argc, char** argv) {
  using namespace nullcone;
  CLI::App app(
      "Follows geodesics, null or timelike: one by numbers, a fan, one carried along a Killing field, the "
      "ray of a pixel, or all light between two places.",
      "nullcone-geodesic");
  GeodesicOptions geodesic;
  ToolOptions options;
  add_geodesic_options(app, geodesic);
  add_common_options(app, options);

  return run_tool(app, argc, argv, [&] {
    check_combination(geodesic);
    if (geodesic.connect) {
      connect_events(geodesic, std::cout);
      return 0;
    }
    if (!geodesic.plot.empty()) check_plot_place(geodesic.plot);
    const Inquiry inquiry = geodesic.scene.empty() ? inquire_by_numbers(geodesic) : inquire_pixel(geodesic);
    if (!geodesic.plot.empty()) write_picture(picture_of(inquiry, geodesic.killing), geodesic.plot);
    if (geodesic.json)
      write_json(inquiry, std::cout);
    else if (geodesic.csv || geodesic.plot.empty())
      write_csv(inquiry, std::cout);
    return 0;
  });
}
