#include "link/protocol.h"

#include "io/ros/ros_codec.h"

namespace patrol::link {

using io::ros::time_field;

template <typename Codec>
void describe(Codec& codec, Hello& hello) {
  codec(hello.protocol);
  codec(hello.program);
  codec(hello.scenario);
  codec(hello.seed);
  time_field(codec, hello.tick);
  codec(hello.limits.forward_mps);
  codec(hello.limits.backward_mps);
  codec(hello.limits.sideways_mps);
  codec(hello.limits.yaw_rate_radps);
  codec(hello.robot);
  codec(hello.site);
  codec(hello.goals);
  codec(hello.registration);
  codec(hello.documents);
}

template <typename Codec>
void describe(Codec& codec, HelloReply& reply) {
  codec(reply.protocol);
  codec(reply.stack);
  codec(reply.topics);
  time_field(codec, reply.turn_period);
}

template <typename Codec>
void describe(Codec& codec, Turn& turn) {
  time_field(codec, turn.now);
  codec(turn.is_last);
}

template <typename Codec>
void describe(Codec& codec, Done& done) {
  time_field(codec, done.now);
  time_field(codec, done.next_turn);
  codec(done.mission_is_over);
}

template <typename Codec>
void describe(Codec& codec, Failure& failure) {
  codec(failure.text);
}

}  // namespace patrol::link

namespace patrol::io {

PATROL_ROS_MESSAGE(link::Hello);
PATROL_ROS_MESSAGE(link::HelloReply);
PATROL_ROS_MESSAGE(link::Turn);
PATROL_ROS_MESSAGE(link::Done);
PATROL_ROS_MESSAGE(link::Failure);

}  // namespace patrol::io
