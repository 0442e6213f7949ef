MODULE M
  PROC main()
    TPWrite "ready; go";
    TPWrite "the ""box""";
    TPWrite "";
    TPWrite "! no comment";
  ENDPROC
ENDMODULE
