"""What is asked of a robot over a whole run. The error budget says where its help was lost, from the trace alone."""
