#include "shallow_sand/ros/contacts_publisher.h"

#include <tf2_eigen/tf2_eigen.h>

#include "shallow_sand/Contacts.h"
#include "shallow_sand/core/moved_volume.h"

namespace shallow_sand {
namespace {

BodyContact toMessage(const SandContact& contact) {
  BodyContact message;
  message.name = contact.name;
  message.submerged_volume = contact.submerged_volume;
  message.touching_area = contact.touching_area;
  message.contact_center = tf2::toMsg(contact.contact_center);
  message.carried_volume = contact.carried_volume;
  message.contact_momentum_x = contact.contact_momentum.x();
  message.contact_momentum_y = contact.contact_momentum.y();
  message.given_momentum_x = contact.given_momentum.x();
  message.given_momentum_y = contact.given_momentum.y();
  return message;
}

}  // namespace

ContactsPublisher::ContactsPublisher(ros::NodeHandle node, const std::vector<float>& start,
                                     const std::string& frame, double rate)
    : start_(start), frame_(frame), period_(1.0 / rate) {
  contacts_ = node.advertise<Contacts>("contacts", 1);
}

bool ContactsPublisher::isDue() const {
  return contacts_.getNumSubscribers() > 0 && ros::WallTime::now() >= next_;
}

void ContactsPublisher::send(const Simulator& simulator, const ros::Time& stamp) {
  next_ = ros::WallTime::now() + period_;
  const Fields fields = simulator.fields();
  const MovedVolume moved = movedVolume(simulator.grid(), start_, fields);
  Contacts message;
  message.header.frame_id = frame_;
  message.header.stamp = stamp;
  message.dug_volume = moved.dug;
  message.heaped_volume = moved.heaped;
  for (const SandContact& contact : simulator.contacts(fields)) message.bodies.push_back(toMessage(contact));
  contacts_.publish(message);
}

}  // namespace shallow_sand
