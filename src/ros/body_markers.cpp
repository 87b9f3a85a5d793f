#include "shallow_sand/ros/body_markers.h"

#include <tf2_eigen/tf2_eigen.h>

#include <algorithm>

namespace shallow_sand {
namespace {

using visualization_msgs::Marker;

Marker markerOf(const ShownBody& body, const std::string& frame) {
  Marker marker = body.appearance.look;
  // The pose is that of the sand's last frame. Without a stamp it holds for whoever comes later, too, when tf
  // has forgotten that time.
  marker.header.frame_id = frame;
  marker.frame_locked = true;
  marker.ns = body.name;
  marker.pose = tf2::toMsg(body.pose);
  return marker;
}

bool sameBody(const Marker& a, const Marker& b) { return a.ns == b.ns; }

bool isIn(const std::vector<Marker>& markers, const Marker& marker) {
  return std::any_of(markers.begin(), markers.end(),
                     [&marker](const Marker& other) { return sameBody(marker, other); });
}

}  // namespace

BodyMarkers::BodyMarkers(ros::NodeHandle node, const std::string& sand_frame)
    : sand_frame_(sand_frame),
      publisher_(node.advertise<visualization_msgs::MarkerArray>("bodies", 1, true)) {}

void BodyMarkers::update(const std::vector<ShownBody>& bodies) {
  visualization_msgs::MarkerArray now;
  for (const ShownBody& body : bodies) now.markers.push_back(markerOf(body, sand_frame_));
  if (now == last_) return;
  visualization_msgs::MarkerArray news = now;
  for (Marker marker : last_.markers) {
    if (isIn(now.markers, marker)) continue;
    marker.action = Marker::DELETE;
    news.markers.push_back(marker);
  }
  publisher_.publish(news);
  last_ = std::move(now);
}

}  // namespace shallow_sand
