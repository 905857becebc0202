"""What goes wrong with a request, as HTTP says it."""
from __future__ import annotations

from http import HTTPStatus
from typing import Dict

from candela._errors import Error

# By kinds of the program's errors. Whatever else fails is the scene's fault.
_STATUS: Dict[str, HTTPStatus] = {"usage": HTTPStatus.BAD_REQUEST, "out_of_memory": HTTPStatus.REQUEST_ENTITY_TOO_LARGE,
                                  "no_device": HTTPStatus.SERVICE_UNAVAILABLE,
                                  "device_lost": HTTPStatus.SERVICE_UNAVAILABLE, "busy": HTTPStatus.SERVICE_UNAVAILABLE,
                                  "failed": HTTPStatus.UNPROCESSABLE_ENTITY}


class Refusal(Exception):
    """The request gets this status and message instead of a picture."""

    def __init__(self, status: HTTPStatus, message: str) -> None:
        super().__init__(message)
        self.status = status

    @classmethod
    def of(cls, error: Error) -> Refusal:
        """What the client is told about an error of the program."""
        return cls(_STATUS.get(error.kind, HTTPStatus.INTERNAL_SERVER_ERROR), str(error))


class Gone(Exception):
    """The client has closed the connection: there is nobody to answer."""
