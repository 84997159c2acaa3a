"""Client of Patrol's turn protocol: software of a robot that takes part in a simulation in lockstep.

    import patrol_client

    def on_turn(turn):
        scan = turn.latest("/scan")
        if scan is not None:
            turn.publish_velocity(0.3 if scan.ranges.min() > 1.0 else 0.0, 0.0, 0.0)

    patrol_client.run(on_turn, topics=["/scan"], turn_period=0.05)

Times are seconds of simulated time since the start of the run. Messages are ROS 2 messages with the fields of their
definitions; arrays of numbers are numpy arrays.
"""

from patrol_client.client import Client, Hello, LinkError, Message, Turn, run

__all__ = ["Client", "Hello", "LinkError", "Message", "Turn", "run"]
