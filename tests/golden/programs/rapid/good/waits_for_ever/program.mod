MODULE M
  PROC main()
    WaitDI di7,1;
    Set do1;
  ENDPROC
ENDMODULE
