"""What a server may do to whoever asks it: how long, how much and how deep its answers may be."""
