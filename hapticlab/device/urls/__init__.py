"""Where pyserial finds the handlers of this package's URLs: protocol_sim for ``sim://``."""
