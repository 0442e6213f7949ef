MODULE M
  VAR num n;
  CONST bool c:=TRUE;
  PROC main()
    WaitDI di1,1\MaxTime:=1\TimeFlag:=n;
    WaitDI di1,1\TimeFlag:=c;
    WaitDI di1,1\TimeFlag:=5;
    WaitDI di1,1\MaxTime=1;
  ENDPROC
ENDMODULE
