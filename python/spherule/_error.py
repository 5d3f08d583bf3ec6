# SPDX-License-Identifier: BSD-3-Clause
"""The exception for bad input."""


class Error(ValueError):
    """Bad input: a file, a mesh, an option or a pose that cannot be used.

    `str()` of it is "subject: reason", where the subject names the file, the option or the argument.
    """

    def __init__(self, subject: str, reason: str) -> None:
        super().__init__(subject, reason)

    @property
    def subject(self) -> str:
        """What cannot be used."""
        return str(self.args[0])

    @property
    def reason(self) -> str:
        """Why."""
        return str(self.args[1])

    def __str__(self) -> str:
        return f"{self.subject}: {self.reason}"
