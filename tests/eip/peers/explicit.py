"""Clients that others wrote (pycomm3, cpppo): ask the adapter who it is, and for its assemblies; prints a line of JSON."""

import json
import sys

from pycomm3 import CIPDriver, Services


def ask(driver, service, class_code, instance, attribute=None, data=b""):
    reply = driver.generic_message(
        service=service,
        class_code=class_code,
        instance=instance,
        attribute=attribute if attribute is not None else b"",
        request_data=data,
        connected=False,
        unconnected_send=False,
        route_path=False,
    )
    return {"value": reply.value.hex() if reply.value is not None else None, "error": reply.error}


host, port = sys.argv[1], int(sys.argv[2])
with CIPDriver(f"{host}:{port}") as driver:
    identity = CIPDriver.list_identity(f"{host}:{port}")
    print(
        json.dumps(
            {
                "product": identity["product_name"],
                "serial": identity["serial"],
                "revision": identity["revision"],
                "all": ask(driver, Services.get_attributes_all, 1, 1),
                "size": ask(driver, Services.get_attribute_single, 4, 150, 4),
                "image": ask(driver, Services.get_attribute_single, 4, 100, 3),
                "nothing": ask(driver, Services.get_attribute_single, 4, 99, 3),
                "write": ask(driver, Services.set_attribute_single, 4, 150, 3, b"Z" * 48),
                "refused": ask(driver, Services.set_attribute_single, 4, 100, 3, bytes(48)),
            }
        )
    )
